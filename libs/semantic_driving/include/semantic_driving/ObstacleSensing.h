#pragma once
#include <semantic_driving/DriveOptions.h>
#include <semantic_planning/planner/SemanticPlanner.h>

namespace semantic_driving {

/** What of the map is an obstacle to a vehicle that drives. */
struct ObstacleOptions {
  /** Radius of the surroundings, meters. */
  double radius = 6;
  /** Ground of forbidden classes, even when flat. */
  bool forbiddenGround = true;
  /** Whatever is not known to be ground. */
  bool unknown = false;
};

/** The obstacles around a vehicle, in its frame (x ahead, y left, meters): centers of columns.
 * There the ground is too steep or of a forbidden class, or something occupied stands above it,
 * between the highest step and the vehicle's height.
 *
 * The ground's height spreads from column to column, from below the vehicle on. Over unknown ground
 * it stays as it was. The unknown is no obstacle, unless it is asked for.
 * \param z height of the ground below the vehicle, meters */
ObstaclePoints senseObstacles(const semantic_planning::SemanticPlanner& planner,
                              const mrpt::math::TPose2D& pose, double z,
                              const ObstacleOptions& options = {});

/** Obstacles in the frame of a vehicle at `from`, in that of one at `to`: those within `radius`
 * meters of it. For a vehicle that drove on while its map was not to be asked. */
ObstaclePoints seenFrom(const ObstaclePoints& obstacles, const mrpt::math::TPose2D& from,
                        const mrpt::math::TPose2D& to, double radius);

}  // namespace semantic_driving
