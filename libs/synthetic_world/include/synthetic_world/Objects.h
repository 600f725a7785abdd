#pragma once
#include <synthetic_world/Random.h>
#include <synthetic_world/Solid.h>
#include <Eigen/Core>

// Things to put into a world. Each stands on `base`, a point of the ground, and reaches some way
// below it, so that a slope leaves no gap. Lengths in meters, yaw in radians.
namespace synthetic_world {

Solids broadleafTree(const Eigen::Vector3d& base, Random& random);
Solids conifer(const Eigen::Vector3d& base, Random& random);
Solids bush(const Eigen::Vector3d& base, Random& random);
Solids rock(const Eigen::Vector3d& base, Random& random);

/** With a gabled roof; the door looks to the yaw's left side.
 * \param size Length along the yaw, width across it. */
Solids house(const Eigen::Vector3d& base, double yaw, const Eigen::Vector2d& size, int storeys,
             Random& random);
/** With a flat roof and windows all around. */
Solids block(const Eigen::Vector3d& base, double yaw, const Eigen::Vector2d& size, int storeys,
             Color tint);

Solids car(const Eigen::Vector3d& base, double yaw, Color tint);
/** \param stride Where in the cycle of walking, in steps; a person that stands has a whole number.
 */
Solids person(const Eigen::Vector3d& base, double yaw, Color clothes, double stride = 0);
Solids bench(const Eigen::Vector3d& base, double yaw);
/** A lamp post; its arm reaches ahead. */
Solids lamp(const Eigen::Vector3d& base, double yaw);
/** A sign on a pole, facing ahead. */
Solids sign(const Eigen::Vector3d& base, double yaw);
/** A plank fence from a to b (points of the ground). */
Solids fencePanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
Solids wallPanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double height);
Solids hedgePanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
/** A barrier of this length across the yaw's direction that closes a road. */
Solids roadblock(const Eigen::Vector3d& base, double yaw, double length);

}  // namespace synthetic_world
