#pragma once
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace semantic_planning {

/** The way of a vehicle that could turn on the spot. */
struct RelaxedPath {
  std::vector<PathPoint> path;  ///< headings are those of travel; empty if there is no way
  double price = 0;             ///< meters; hardly any path of the vehicle costs less
  /** Without a way: the place nearest to the goal that can be reached. */
  std::optional<mrpt::math::TPoint2D> nearest;
};

/** What a length of each rank counts, driving it included, in sixteenths of its own. */
constexpr std::int64_t kWeightOfLength = 16;
std::vector<std::int64_t> weightsOfRanks(const colored_graph::ClassOrder& order);

/** From column to column in eight directions, wherever there is ground: the way of least price. It
 * knows no turning radius. \param overForbidden also over what the order forbids, at the price of
 * the worst rank */
RelaxedPath searchRelaxed(const CollisionChecker& checker, const GroundPose& start,
                          const GroundPose& goal, bool overForbidden = false);

}  // namespace semantic_planning
