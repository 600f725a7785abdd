#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <semantic_driving/ObstacleSensing.h>

namespace semantic_driving {

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
