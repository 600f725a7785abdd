#pragma once
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <cstdint>
#include <vector>

namespace planning_study {

/** A task for all planners. Meters, radians; map frame. */
struct Instance {
  mrpt::math::TPose2D start, goal;
};

/** Pairs of poses, drawn evenly over the ground where the vehicle can stand, with any heading; each
 * pair is connected by ground and at least `minDistance` meters apart. They depend on the ground,
 * the count and the seed alone: not on any graph. The first n of more are those of n.
 * \throw std::runtime_error hardly any such pair is found. */
std::vector<Instance> drawInstances(const semantic_planning::CollisionChecker& checker,
                                    std::size_t count, double minDistance, std::uint64_t seed);

}  // namespace planning_study
