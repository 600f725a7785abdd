#include <synthetic_world/Objects.h>
#include <synthetic_world/Scene.h>

#include <cmath>
#include <stdexcept>

#include "SceneBuilder.h"

namespace synthetic_world {

namespace {

struct Maker {
  const char* name;
  Scene (*make)(std::uint64_t seed, double hills);
};
constexpr Maker kMakers[] = {{"village", makeVillage}, {"park", makePark}, {"campus", makeCampus}};

}  // namespace

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const Maker& m : kMakers) names.emplace_back(m.name);
  return names;
}

Scene makeScene(const std::string& name, std::uint64_t seed, double hills) {
  if (!(hills >= 0 && hills <= 2))
    throw std::invalid_argument("scene: hills is " + std::to_string(hills) + ", 0 to 2 expected");
  std::string known;
  for (const Maker& m : kMakers) {
    if (name == m.name) return m.make(seed, hills);
    known += (known.empty() ? "" : ", ") + std::string(m.name);
  }
  throw std::invalid_argument("scene: no scene '" + name + "'; there are: " + known);
}

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
