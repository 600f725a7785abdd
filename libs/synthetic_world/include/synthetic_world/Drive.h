#pragma once
#include <synthetic_world/Scene.h>
#include <Eigen/Geometry>

namespace synthetic_world {

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

/** A person who walks to and fro between two points; see Objects.h for the look. */
struct Walker {
  Eigen::Vector2d from, to;
  double speed = 1.2;  // m/s
  Color clothes{188, 62, 52};

  /** The person at a time in seconds, to be given to World::setMovables(). */
  Solids at(const World& world, double time) const;
};

}  // namespace synthetic_world
