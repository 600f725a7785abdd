#pragma once
#include <semantic_map/MapPictures.h>

#include <array>
#include <limits>
#include <vector>

namespace semantic_map {

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
  std::vector<MapCell> cells;
  /** Nothing finer than this depth is drawn. */
  unsigned depth;
  /** Nothing with its center above is drawn, m. */
  double maxHeight = std::numeric_limits<double>::infinity();
  double minOccupancy;

  /** Number of cells per class, [0] those without. */
  std::vector<std::size_t> countClasses(int numClasses) const;
};

/** The occupied cells of a map, in OctoMap's order; coarser ones if there are more than a picture
 * can show. Cuts off what the style says. */
MapCells collectCells(const semantic_octree::SemanticOcTree& tree, const PictureStyle& style);

/** Where nearly all of the cells are: a few of a thousand far away do not count. */
struct Extent {
  Eigen::Vector3f low, high;
};
Extent extentOf(const std::vector<MapCell>& cells);

/** The height under the lowest ceiling if the cells are those of an indoor map: if most columns end
 * in a surface at nearly one height with room to stand below. Infinite otherwise. */
double heightUnderCeiling(const std::vector<MapCell>& cells);

}  // namespace semantic_map
