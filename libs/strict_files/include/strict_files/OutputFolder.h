#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace strict_files {

/** The folder of the results. Files are written into a folder inside it and take their place at the
 * end, all of them: what was there stays if anything fails. */
class OutputFolder {
 public:
  /** Creates the folder, with those above it.
   * \throw std::runtime_error naming the folder, if it cannot be written to. */
  explicit OutputFolder(std::filesystem::path folder);
  /** Removes what was not committed. */
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /** Where to write a file. */
  std::filesystem::path staged(const std::string& name) const { return m_staging / name; }
  /** Puts these files in place. One that was not written removes its predecessor, so that files of
   * different maps are never side by side. \throw std::runtime_error naming the file. */
  void commit(const std::vector<std::string>& names);

 private:
  std::filesystem::path m_folder, m_staging;
  bool m_createdFolder;
};

}  // namespace strict_files
