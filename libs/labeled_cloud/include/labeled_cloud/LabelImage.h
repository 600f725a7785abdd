#pragma once
#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservation.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/OptionList.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace labeled_cloud {

/** The class of every pixel of a picture, or how likely each class is there. Its cells are the
 * picture's pixels, or larger ones, as networks answer. */
struct LabelImage {
  int rows = 0, cols = 0;
  /** rows x cols, row-major; kNoClass where a cell has none. Empty if there are probabilities. */
  std::vector<semantic_types::ClassId> classes;
  /** rows x cols: probability that the class is right. Empty: nothing is known about that. */
  std::vector<float> confidences;
  /** K planes of rows x cols, plane k for class k + 1; they sum to 1, or to 0 where a cell has no
   * class. Empty: `classes` holds. */
  std::vector<float> probabilities;
  /** Where it comes from, for messages: a file, or the observation. */
  std::string origin;

  /** Which picture of an observation that has both. */
  enum class View { Depth, Color };
  View view = View::Depth;

  /** How the picture's pixels fall into the cells: column (c + 1/2) scaleX, row (r + 1/2) scaleY -
   * shiftY, rounded down. */
  struct Cells {
    /** Size of the picture in pixels. 0: that of the label image. */
    int pictureRows = 0, pictureCols = 0;
    double scaleX = 1, scaleY = 1, shiftY = 0;
  };
  Cells cells;

  int pictureRows() const { return cells.pictureRows ? cells.pictureRows : rows; }
  int pictureCols() const { return cells.pictureCols ? cells.pictureCols : cols; }
  /** Index of the cell of a picture's pixel (column u, row v, whole numbers are pixels' centers),
   * if it has one. */
  std::optional<std::size_t> cellAt(double u, double v) const;
  /** The (likeliest) class of a cell. */
  semantic_types::ClassId classOf(std::size_t cell) const;
};

inline strict_files::Choices<LabelImage::View> choicesOf(LabelImage::View) {
  return {{"depth", LabelImage::View::Depth}, {"color", LabelImage::View::Color}};
}

/** Whatever finds the label image of an observation: a field of it, a folder of images, a network.
 */
class ImageLabeler {
 public:
  virtual ~ImageLabeler() = default;

  /** The label image of an observation that has an image, or nothing if there is none for it.
   * \throw std::runtime_error the label image is there but cannot be used: names it and why. */
  virtual std::optional<LabelImage> label(const mrpt::obs::CObservation& observation) = 0;
};

/** The labels in CObservation3DRangeScan::pixelLabels, which holds at most 64 classes.
 *
 * MRPT does not say which image they belong to: the depth image, unless told otherwise.
 * Label i stands for the class of its name in `pixelLabelNames`; where it has no name, for the raw
 * id i of the class table. A pixel without labels has no class, one with several has the lowest. */
class EmbeddedLabels : public ImageLabeler {
 public:
  explicit EmbeddedLabels(const semantic_types::ClassTable& table,
                          LabelImage::View view = LabelImage::View::Depth)
      : m_table(table), m_view(view) {}

  /** \throw std::runtime_error a label of a pixel is not in the class table (and the table takes
   * that for an error). */
  std::optional<LabelImage> label(const mrpt::obs::CObservation& observation) override;

 private:
  semantic_types::ClassTable m_table;
  LabelImage::View m_view;
};

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
inline strict_files::Choices<LabelFolderOptions::Match> choicesOf(LabelFolderOptions::Match) {
  return {{"time", LabelFolderOptions::Match::Time}, {"name", LabelFolderOptions::Match::Name}};
}

/** Label images in a folder (PNG), one for each image of a camera, of its size.
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
  /** \throw std::runtime_error naming the folder or file: none, no label image in it, or
   * (Match::Time) a name that is no time, or two of one time. */
  LabelFolder(const std::filesystem::path& folder, const semantic_types::ClassTable& table,
              const LabelFolderOptions& options = {});

  /** \throw std::runtime_error naming the file: unreadable, of another kind, an id or color that
   * the class table lacks, or (Match::Name) an observation without external image. */
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
