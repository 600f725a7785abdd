#include "Doubts.h"

#include <mrpt/core/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "measuring/Measuring.h"

namespace rawlog2semantic_map {

using semantic_octree::SemanticOcTree;

namespace {

/** What makes meters of millimeters, or millimeters of meters. */
constexpr double kUnits = 1000;
/** No sensor of a robot sees half of its points farther away, m, and hardly one whose range is
 * limited. */
constexpr double kFarthest = 1000, kFarOfLimited = 100;

}  // namespace

void Doubts::add(const labeled_cloud::LabeledScan& scan, const Eigen::Isometry3d& T_map_sensor) {
  constexpr float kSteep = 0.1f;  // m a meter; a laser scanner has none
  const Eigen::RowVector3f up = T_map_sensor.linear().row(2).cast<float>();
  std::vector<double> ranges;
  // Some thousand points tell it as well as all.
  for (std::size_t i = 0; i < scan.cloud.size(); i += 1 + scan.cloud.size() / 1000) {
    const Eigen::Vector3f& p = scan.cloud.points[i];
    ranges.push_back(static_cast<double>(p.norm()));
    m_above += up * p > kSteep * p.norm();
    m_below += up * p < -kSteep * p.norm();
  }
  m_ranges.push_back(measuring::quantile(std::move(ranges), 0.5));
  m_places.push_back(T_map_sensor.translation());
}

bool Doubts::isUpsideDown(const SemanticOcTree& map) const {
  if (m_above <= 2 * m_below) return false;
  constexpr std::size_t kMostPlaces = 50;
  constexpr double kFar = 30;            // m
  std::set<std::array<int, 2>> columns;  // of 1 m: a robot that stands is in one place
  double below = 0, above = 0;
  const auto look = [&](double x, double y, double z) {
    if (!columns.insert({int(std::floor(x)), int(std::floor(y))}).second) return;
    const auto has = [&](float up) {
      return map.castRay({float(x), float(y), float(z)}, {0, 0, up}, kFar).has_value();
    };
    const bool down = has(-1), up = has(1);
    below += down && !up, above += up && !down;
  };
  for (std::size_t i = 0; i < m_places.size(); i += 1 + m_places.size() / kMostPlaces)
    for (const double radius : {0., 2.5, 5.})  // LiDARs do not see what is right below them
      for (int k = 0; k < (radius > 0 ? 8 : 1); ++k)
        look(m_places[i].x() + radius * std::cos(k * M_PI / 4),
             m_places[i].y() + radius * std::sin(k * M_PI / 4), m_places[i].z());
  // By more than two standard deviations of what chance does.
  return above > 3 * below && above - below > 2 * std::sqrt(above + below);
}

std::vector<std::string> Doubts::warnings(const SemanticOcTree& map, double maxRange) const {
  std::vector<std::string> texts;
  if (m_places.empty()) return texts;
  if (isUpsideDown(map))
    texts.push_back(
        "around the robot things are above the sensor and no ground is below it: is the sensor "
        "upside down? Its pose on the robot needs a roll of 180 degrees then");
  const double nearest = map.getResolution(), most = maxRange > 0 ? maxRange : kFarthest;
  const double range = measuring::quantile(m_ranges, 0.5);
  const bool isNear = range <= nearest;
  const double fits = isNear ? range * kUnits : range / kUnits;
  if ((isNear || range >= std::max(most, kFarOfLimited)) && fits > nearest && fits < most)
    texts.push_back(mrpt::format(
        "half of the points are %s than %.3g m: are their ranges in another unit? %s by %g they "
        "would fit (depth_factor in camera.ini, rangeUnits of depth images)",
        isNear ? "nearer" : "farther", range, isNear ? "Multiplied" : "Divided", kUnits));
  return texts;
}

}  // namespace rawlog2semantic_map
