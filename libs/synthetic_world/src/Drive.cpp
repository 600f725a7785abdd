#include <synthetic_world/Objects.h>
#include <synthetic_world/Scene.h>

#include <cmath>
#include <stdexcept>

namespace synthetic_world {

Drive::Drive(const Scene& scene, double speed, double start)
    : m_scene(&scene), m_speed(speed), m_start(start) {
  if (!(speed > 0)) throw std::invalid_argument("drive: a positive speed expected");
}

Eigen::Isometry3d Drive::T_world_robot(double time) const {
  const double s = m_start + m_speed * time;
  const Eigen::Vector2d at = m_scene->route.at(s);
  return m_scene->world.poseOnGround(at.x(), at.y(), m_scene->route.heading(s));
}

Solids Walker::at(const World& world, double time) const {
  constexpr double kStep = 0.7;  // m
  const Eigen::Vector2d way = to - from;
  const double length = way.norm(), walked = speed * time;
  const double phase = std::fmod(walked, 2 * length);
  const bool back = phase > length;
  const Eigen::Vector2d at = from + way / length * (back ? 2 * length - phase : phase);
  const double yaw = std::atan2(way.y(), way.x()) + (back ? M_PI : 0);
  return person({at.x(), at.y(), world.groundHeight(at.x(), at.y())}, yaw, clothes, walked / kStep);
}

}  // namespace synthetic_world
