#pragma once
#include <semantic_abstraction/Abstraction.h>
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

/** The obstacles around a vehicle, in its frame (x ahead, y left, meters): centers of columns where
 * something occupied stands between the highest step and the vehicle's height above the ground
 * there, where the ground is too steep, or of a forbidden class.
 *
 * How high the ground is spreads from column to column, from below the vehicle on; over ground that
 * is not known the height stays as it was. The unknown is no obstacle, unless it is asked for.
 * \param z height of the ground below the vehicle, meters */
ObstaclePoints senseObstacles(const semantic_planning::SemanticPlanner& planner,
                              const mrpt::math::TPose2D& pose, double z,
                              const ObstacleOptions& options = {});

/** As senseObstacles(), with heights above the ground, meters: centers of the voxels that are in
 * the way, for a vehicle that is not as wide at all heights. Where the ground itself is an
 * obstacle, there is one at each height. */
ObstaclePoints3 senseObstacles3(const semantic_planning::SemanticPlanner& planner,
                                const mrpt::math::TPose2D& pose, double z,
                                const ObstacleOptions& options = {});

/** Obstacles in the frame of a vehicle at `from`, in that of one at `to`: those within `radius`
 * meters of it. For a vehicle that drove on while its map was not to be asked. */
ObstaclePoints seenFrom(const ObstaclePoints& obstacles, const mrpt::math::TPose2D& from,
                        const mrpt::math::TPose2D& to, double radius);

/** As senseObstacles(), from the leaves of the compressed tree: an occupied leaf is an obstacle as
 * a whole, so that nothing is missed, but up to a leaf's edge too much is in the way. How large
 * leaves are is a matter of the abstraction: one that does not tell obstacles from air, as
 * semantic_planning::abstractionFor(), has leaves with much air around them.
 * \param compressed of the planner's map
 * \return centers of the columns at the border of what the leaves cover */
ObstaclePoints senseCompressedObstacles(const semantic_planning::SemanticPlanner& planner,
                                        const semantic_octree::Abstraction& compressed,
                                        const mrpt::math::TPose2D& pose, double z,
                                        const ObstacleOptions& options = {});

}  // namespace semantic_driving
