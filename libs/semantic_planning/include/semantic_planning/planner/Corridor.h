#pragma once
#include <colored_graph/ClassOrder.h>
#include <mrpt/math/TPose2D.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_planning/ground/Surface.h>

#include <optional>
#include <vector>

namespace semantic_planning {

struct PlannerOptions;

/** Where a plan looks at the ground of a map of which all would be too much: near a way. Meters,
 * map frame. */
struct Corridor {
  std::vector<mrpt::math::TPoint2D> way;  ///< from start to goal, about a tile of ground apart
  double width = 0;                       ///< to each side
  double reach = 0;  ///< the ground may depend on what the map holds that far from it

  /** The tiles of ground that meet it, sorted. */
  std::vector<Column> tiles(double voxelSize) const;
  /** Whether a plan may depend on what the map holds in a rectangle, at whatever height. */
  bool mayNeed(const mrpt::math::TPoint2D& low, const mrpt::math::TPoint2D& high) const;
};

struct CorridorTask {
  mrpt::math::TPose2D start, goal;
  std::optional<double> startZ, goalZ;  ///< as SemanticPlanner::plan()
  double width = 30;                    ///< of the corridor to each side, meters
};

/** Finds the least way through the worst class, then through the next better one, and so on, from
 * one tile of ground to the next. Parts of a tile are apart if a vehicle that turns on the spot
 * does not get from one to the other within the tile. A part has the best class that is there from
 * side to side. The ground is made square by square (512 columns a side) when the search comes
 * there, and forgotten but for its parts. So little more than a square of a map in tiles is needed
 * at a time.
 *
 * Without a way, or with start or goal off drivable ground, the corridor is around these two. A
 * plan in it says what is the matter.
 * \throw std::invalid_argument a number is not finite, bad options, or an order of other classes
 * \throw std::runtime_error naming the file of a tile that cannot be read, of a map in a folder */
Corridor findCorridor(const semantic_octree::SemanticOcTree& map,
                      const colored_graph::ClassOrder& order, const PlannerOptions& options,
                      const CorridorTask& task);

}  // namespace semantic_planning
