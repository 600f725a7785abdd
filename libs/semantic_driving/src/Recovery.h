#pragma once
#include <semantic_driving/DrivePath.h>
#include <semantic_planning/planner/SemanticPlanner.h>

namespace semantic_driving {

/** From where a vehicle must not be, a way to where it may: over ground of a forbidden class, or
 * too close to something. Reeds-Shepp curves lead to places between `nearest` and 8 m away
 * from which the planner can plan. It is the shortest one among those with the least way over
 * forbidden ground. The curve keeps the footprint free, but no clearance. Empty if there is none.
 * \param z height of the ground below the vehicle, meters \param nearest meters */
DrivePath findRecovery(const semantic_planning::SemanticPlanner& planner,
                       const mrpt::math::TPose2D& from, double z, double nearest = 0);

}  // namespace semantic_driving
