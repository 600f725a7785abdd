#pragma once
#include <semantic_planning/SemanticPlanner.h>

#include <vector>

namespace semantic_planning {

/** How places to explore are looked for. */
struct FrontierOptions {
  double radius = 40;        ///< how far over known ground, meters
  double unknownFactor = 2;  ///< what a meter through the unknown counts against one on rank 0
  double apart = 3;          ///< between places, meters
  std::size_t most = 6;      ///< places
};

/** A place at the border of what is known. */
struct Frontier {
  mrpt::math::TPose2D pose;  ///< headed as one comes there
  double z = 0;              ///< height of the ground, meters
  double cost = 0;           ///< weighted meters by way of it to the goal
};

/** Places on drivable ground next to unknown space from which to see more of the way to a goal,
 * most promising first: least way there, where rank r counts r + 1 times, and on through the
 * unknown. (Yamauchi, "A frontier-based approach for autonomous exploration", 1997, with a goal.)
 * \param from where the vehicle is, on ground of height z (meters)
 * \param avoid places that are not looked for again, nor others within `apart` of them */
std::vector<Frontier> findFrontiers(const SemanticPlanner& planner, const mrpt::math::TPose2D& from,
                                    double z, const mrpt::math::TPose2D& goal,
                                    const std::vector<mrpt::math::TPose2D>& avoid,
                                    const FrontierOptions& options = {});

}  // namespace semantic_planning
