#pragma once
#include <labeled_cloud/LabelImage.h>
#include <mrpt/core/Clock.h>

#include <filesystem>
#include <map>
#include <vector>

namespace labeled_cloud {

struct LabelFolderOptions {
  enum class Match {
    /** File names are times in seconds ("12.250.png"); the nearest one counts. */
    Time,
    /** The label image is named like the observation's external image, ending apart. */
    Name
  };
  Match match = Match::Time;
  /** Match::Time: largest difference to the observation's time, s. */
  double tolerance = 0.02;
  /** Which image of a depth and color camera the labels belong to. */
  LabelImage::View view = LabelImage::View::Depth;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};
const strict_files::Choices<LabelFolderOptions::Match>& choicesOf(LabelFolderOptions::Match);

/** Label images in a folder (PNG, TIFF, PGM or BMP), one for each image of a camera, of its size.
 *
 * - gray with 8 or 16 bits: the values are raw ids of the class table
 * - with a palette: so are the palette's indices, whatever its colors
 * - in color: colors of the class table; black, where no class has it, is raw id 0
 *
 * Beside NAME.png may be NAME.confidence.png, gray with 8 or 16 bits: the probability that each
 * label is right, from 0 to the largest value. Where the first image of a folder has one, all must.
 */
class LabelFolder : public ImageLabeler {
 public:
  /** \throw std::runtime_error naming the folder or file: no such folder, no label image in it, or
   * (Match::Time) a file whose name is not a time, or two of one time. */
  LabelFolder(const std::filesystem::path& folder, const semantic_types::ClassTable& table,
              const LabelFolderOptions& options = {});

  /** \throw std::runtime_error naming the file: unreadable, of another kind, or an id or color that
   * the class table does not know; or (Match::Name) the observation has no external image. */
  std::optional<LabelImage> label(const mrpt::obs::CObservation& observation) override;

 private:
  std::optional<std::filesystem::path> fileOf(const mrpt::obs::CObservation& observation) const;
  std::optional<std::filesystem::path> nearest(mrpt::Clock::time_point time) const;
  std::optional<std::filesystem::path> named(const mrpt::obs::CObservation& observation) const;

  std::filesystem::path m_folder;
  semantic_types::ClassTable m_table;
  LabelFolderOptions m_options;
  bool m_withConfidences = false;
  std::map<mrpt::Clock::time_point, std::filesystem::path> m_byTime;
  std::map<std::string, std::filesystem::path> m_byName;
};

/** Reads one label image, see LabelFolder.
 * \throw std::runtime_error naming the file, and pixel and value where one is to blame. */
LabelImage readLabelImage(const std::filesystem::path& file,
                          const semantic_types::ClassTable& table);

/** Gives a label image the confidences in FILE. \throw std::runtime_error naming the file: it is
 * unreadable, not gray with 8 or 16 bits, or of another size. */
void readConfidences(const std::filesystem::path& file, LabelImage& image);

}  // namespace labeled_cloud
