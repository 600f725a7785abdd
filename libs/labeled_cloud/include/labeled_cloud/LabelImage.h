#pragma once
#include <mrpt/obs/CObservation.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/OptionList.h>

#include <cstddef>
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

const strict_files::Choices<LabelImage::View>& choicesOf(LabelImage::View);

/** Whatever finds the label image of an observation: a field of it, a folder of images, a network.
 */
class ImageLabeler {
 public:
  virtual ~ImageLabeler() = default;

  /** The label image of an observation that has an image, or nothing if there is none for it.
   * \throw std::runtime_error the label image is there but cannot be used: names it and why. */
  virtual std::optional<LabelImage> label(const mrpt::obs::CObservation& observation) = 0;

  /** How many observations are better labeled at once than one by one. */
  virtual std::size_t batch() const { return 1; }
  /** The label images of up to batch() observations. \throw std::runtime_error as above. */
  virtual std::vector<std::optional<LabelImage>> label(
      const std::vector<const mrpt::obs::CObservation*>& observations) {
    std::vector<std::optional<LabelImage>> images;
    for (const auto* observation : observations) images.push_back(label(*observation));
    return images;
  }
};

}  // namespace labeled_cloud
