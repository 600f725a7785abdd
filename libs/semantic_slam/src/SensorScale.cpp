#include "SensorScale.h"

#include <algorithm>
#include <cmath>

namespace semantic_slam {
namespace {

/** Median distance of points from the robot, m; 0 of none. */
double medianDistance(const LabeledCloud& cloud) {
  std::vector<float> distances;
  for (const Eigen::Vector3f& p : cloud.points) distances.push_back(p.norm());
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace

SensorScale SensorScale::of(const LabeledCloud& cloud, bool isPlanar) {
  if (isPlanar) return {true, 0.4, 8 * kDegree, 20, 0.05, 0, {2, 1, 0.5}, 0.1, 10, 0.8};
  // Streets have a median of some 8 m, rooms of 2 m. Powers of two: nearby medians act alike.
  constexpr double kStreet = 8;
  const double octaves = std::round(std::log2(std::max(medianDistance(cloud), 1e-3) / kStreet));
  const double size = std::exp2(std::clamp(octaves, -2., 0.));
  return {false,      0.8 * size,       15 * kDegree, 10,        0.25 * size,
          0.5 * size, {2 * size, size}, 0.4 * size,   30 * size, 0.6};
}

void LocalMap::add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_last_keyframe,
                   const SensorScale& scale, bool useClasses) {
  const auto most = static_cast<std::size_t>(scale.submapKeyframes);
  for (Part& part : m_parts) part.poses.push_back(rigid(part.poses.back() * T_last_keyframe));
  if (m_parts.empty() || (m_parts.size() == 1 && m_parts[0].poses.size() > most)) {
    Part& part = m_parts.emplace_back();
    for (const double size : scale.cells)
      part.submaps.emplace_back(size, useClasses, scale.isPlanar);
    part.poses.push_back(Eigen::Isometry3d::Identity());
  }
  for (Part& part : m_parts)
    for (Submap& submap : part.submaps) {
      submap.add(cloud, part.poses.back());
      submap.finish();
    }
  if (m_parts.front().poses.size() >= 2 * most) m_parts.pop_front();
}

}  // namespace semantic_slam
