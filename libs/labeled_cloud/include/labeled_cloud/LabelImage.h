#pragma once
#include <mrpt/obs/CObservation.h>
#include <semantic_octree/ClassTable.h>

#include <optional>
#include <string>
#include <vector>

namespace labeled_cloud {

/** The class of every pixel of an image. */
struct LabelImage {
  int rows = 0, cols = 0;
  /** rows x cols, row-major; kNoClass where a pixel has none. */
  std::vector<semantic_octree::ClassId> classes;
  /** Where it comes from, for messages: a file, or the observation. */
  std::string origin;
};

/** Whatever finds the label image of an observation: a field of it, a folder of images, a network.
 */
class ImageLabeler {
 public:
  virtual ~ImageLabeler() = default;

  /** The label image of an observation that has an image, or nothing if there is none for it. The
   * labels of a CObservation3DRangeScan are those of its DEPTH image's pixels.
   * \throw std::runtime_error the label image is there but cannot be used: names it and why. */
  virtual std::optional<LabelImage> label(const mrpt::obs::CObservation& observation) = 0;
};

}  // namespace labeled_cloud
