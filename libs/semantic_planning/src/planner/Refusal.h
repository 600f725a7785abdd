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

}  // namespace semantic_planning
