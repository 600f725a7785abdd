#pragma once
#include <synthetic_world/World.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

namespace synthetic_world {

/** A place, and a round trip through it. */
struct Scene {
  World world;
  Curve route;  // closed, in the right lane of the roads

  /** A robot on the route, s meters from its start as seen from above: on the ground, with the
   * pitch and roll of the slope. */
  Eigen::Isometry3d T_world_robot(double s) const;
};

/** village: a ring of streets with houses, gardens, a pond. park: lawns, trees, gravel paths around
 * a lake, on hills. campus: blocks with flat roofs, a plaza, a parking lot, straight streets. */
std::vector<std::string> sceneNames();

/** The scene of this name; the same for the same seed.
 * \param hills Factor of all heights of the ground: 0 is flat, 1 as designed, at most 2.
 * \throw std::invalid_argument unknown name (the message lists the known), or hills out of range.
 */
Scene makeScene(const std::string& name, std::uint64_t seed, double hills = 1.0);

}  // namespace synthetic_world
