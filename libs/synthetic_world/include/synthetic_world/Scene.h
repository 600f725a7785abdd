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
};

/** village: a ring of streets with houses, gardens, a pond. park: lawns, trees, gravel paths around
 * a lake, on hills. campus: blocks with flat roofs, a plaza, a parking lot, straight streets. */
std::vector<std::string> sceneNames();

/** The scene of this name; the same for the same seed.
 * \param hills Factor of all heights of the ground: 0 is flat, 1 as designed, at most 2.
 * \throw std::invalid_argument unknown name (the message lists the known), or hills out of range.
 */
Scene makeScene(const std::string& name, std::uint64_t seed, double hills = 1.0);

/** A robot that follows a curve over the ground at constant speed.
 *
 * The scene must outlive the drive. */
class Drive {
 public:
  /** \param speed Meters of the curve, seen from above, per second.
   * \param start Meters along the curve at time 0.
   * \throw std::invalid_argument the speed is not positive. */
  explicit Drive(const Scene& scene, double speed = 1.5, double start = 0);

  /** Seconds for one round. */
  double duration() const { return m_scene->route.length() / m_speed; }
  /** At a time in seconds: on the ground, with the pitch and roll of the slope. */
  Eigen::Isometry3d T_world_robot(double time) const;

 private:
  const Scene* m_scene;
  double m_speed, m_start;
};

}  // namespace synthetic_world
