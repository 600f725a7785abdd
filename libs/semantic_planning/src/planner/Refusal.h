#pragma once
#include <semantic_planning/ground/Ground.h>
#include <semantic_planning/planner/PlanResult.h>
#include <semantic_planning/planner/SemanticPlanner.h>
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <optional>
#include <string>
#include <vector>

namespace semantic_planning {

/** What keeps a vehicle from standing somewhere, and where that is. */
struct Refusal {
  mrpt::math::TPoint2D place;  ///< middle of a column, meters, map frame
  std::string what;            ///< such as "ground not known"
};

/** \param status of the pose as a start, not PlanStatus::Found \param placed none: off ground */
Refusal refusalOf(const CollisionChecker& checker, PlanStatus status,
                  const mrpt::math::TPose2D& pose, const std::optional<GroundPose>& placed);

/** What a vehicle stands on where the map knows no ground: a LiDAR on its roof does not see what is
 * near. Ground that is known all around, within 10 m, tells height and class.
 * \param z height of the vehicle's origin, meters; none: as the ground around
 * \return the columns of the footprint and the clearance around it in which the map has no surface;
 * none if ground is not known on all four sides, or is forbidden */
std::vector<GroundPoint> groundBelow(const Ground& ground, const VehicleOptions& vehicle,
                                     const mrpt::math::TPose2D& pose, std::optional<double> z);

}  // namespace semantic_planning
