#pragma once
#include <map_pictures/MapPictures.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "LowestCells.h"

namespace map_pictures {

/** A cell that a picture shows: an occupied leaf, or an occupied inner node of the drawn depth. */
struct MapCell {
  octomap::OcTreeKey key;  ///< of its center
  unsigned depth;
  Eigen::Vector3f center;  ///< m
  float size;              ///< edge, m
  semantic_types::ClassId id;
};

/** What a picture shows of a map. */
struct MapCells {
  /** Cells count as occupied above this occupancy. */
  static constexpr double kOccupied = 0.5;

  std::vector<MapCell> cells;
  /** Nothing finer than this depth is drawn. */
  unsigned depth;
  /** Nothing with its center above is drawn, m. */
  double maxHeight = std::numeric_limits<double>::infinity();
  /** Nothing with its center that much above the lowest cells around is drawn, m. */
  double maxAboveGround = std::numeric_limits<double>::infinity();
  LowestCells ground;  ///< for that; empty if nothing is cut off so

  bool isCutOff(const Eigen::Vector3f& center) const {
    return center.z() > maxHeight ||
           (std::isfinite(maxAboveGround) &&
            center.z() - ground.around(center.x(), center.y()) > maxAboveGround);
  }
  /** Number of cells per class, [0] those without. */
  std::vector<std::size_t> countClasses(int numClasses) const;
};

/** The occupied cells of a map, in OctoMap's order; coarser ones if there are more than a picture
 * can show. Cuts off what the style says. \param part where they are, m; none: everywhere */
MapCells collectCells(const semantic_octree::SemanticOcTree& tree, const PictureStyle& style,
                      const std::optional<Eigen::AlignedBox2d>& part = {});

/** The value below which that share of the values is, one of them; changes their order. */
template <class T>
T quantile(std::vector<T>& values, double share) {
  const auto nth = values.begin() + std::ptrdiff_t(share * double(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

/** Where nearly all of the cells are: a few of a thousand far away do not count. */
struct Extent {
  Eigen::Vector3f low, high;
};
Extent extentOf(const std::vector<MapCell>& cells);

/** The height under the lowest ceiling if the cells are those of an indoor map: if most columns end
 * in a surface at nearly one height with room to stand below. Infinite otherwise. */
double heightUnderCeiling(const std::vector<MapCell>& cells);

}  // namespace map_pictures
