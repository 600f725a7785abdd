#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace map_pictures {

/** A picture of the map from above that geographic software places by itself: north (up) is +y. */
struct ClassMap {
  /** BGR. The map at the left, whole pixels for each column of voxels in the exact color of the
   * likeliest class of its highest occupied leaf; the legend at the right. */
  cv::Mat picture;
  double metersPerPixel = 0;
  cv::Point2d upperLeft;  ///< outer corner of pixel (0, 0), m, map frame

  /** The six lines of a world file (.pgw). */
  std::string worldFile() const;
};

/** \param maxHeight leaves with their center above are not drawn, m; without: nothing is cut off,
 * except the ceiling of a map that lies under one
 * \throw std::runtime_error nothing is occupied, or the map is too wide for a picture. */
ClassMap classMapOf(const semantic_octree::SemanticOcTree& tree,
                    const std::optional<double>& maxHeight = {});

}  // namespace map_pictures
