#pragma once
#include <labeled_cloud/ScanConverter.h>
#include <semantic_types/ClassTable.h>

#include <filesystem>
#include <string>

namespace rawlog2semantic_map {

/** Pictures that show whether labels and calibration are right: above, the labels over the image;
 * below, the scan's points over the image, in their classes' colors, gray where they have none. */
class Preview {
 public:
  /** Creates the folder if need be. \throw std::runtime_error naming it, if it cannot be. */
  Preview(const std::filesystem::path& folder, const semantic_types::ClassTable& classes);

  /** The name of the i-th picture's file. */
  static std::string nameOf(std::size_t i);

  /** Writes a picture for each one that the scan's labels are from.
   * \throw std::runtime_error naming the file, if it cannot be written. */
  void write(const labeled_cloud::LabeledScan& scan);

 private:
  std::filesystem::path m_folder;
  semantic_types::ClassTable m_classes;
  std::size_t m_written = 0;
};

}  // namespace rawlog2semantic_map
