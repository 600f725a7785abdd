#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>

#include <optional>
#include <string>

namespace semantic_driving {

/** What keeps a vehicle from standing at a goal. */
struct GoalMisfit {
  mrpt::math::TPoint2D at;  ///< the middle of a column that is in the way, map frame, meters
  semantic_types::ClassId classId = semantic_types::kNoClass;  ///< of what is there
};

/** What is known to be in the way of a vehicle at a goal, or its clearance, nearest to the goal
 * first; nothing if there is nothing, or too little is known. As SemanticPlanner::check() does, but
 * for what is not known: that may turn out to be ground.
 *
 * Heights of the ground spread from below the vehicle. Beyond ground that was not seen they are
 * guessed, so that only what stands next to ground that was seen counts.
 * \param from where the vehicle is, on ground of height z (meters) */
std::optional<GoalMisfit> findMisfit(const semantic_planning::SemanticPlanner& planner,
                                     const mrpt::math::TPose2D& from, double z,
                                     const mrpt::math::TPose2D& goal);

/** The pose nearest to a goal where the vehicle fits and can get to over known ground: least
 * distance, a half turn counting as 1.5 m. Nothing if there is none within a distance (meters).
 * \param from where the vehicle is, on ground of height z (meters) */
std::optional<mrpt::math::TPose2D> nearestFit(const semantic_planning::SemanticPlanner& planner,
                                              const mrpt::math::TPose2D& from, double z,
                                              const mrpt::math::TPose2D& goal, double within);

/** A sentence on what is in the goal's way. */
std::string describe(const GoalMisfit& misfit, const mrpt::math::TPose2D& goal,
                     const semantic_types::ClassTable& classes);

}  // namespace semantic_driving
