#include "SensorScale.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace semantic_slam {
namespace {

/** From the robot, m: half of the surface that a scan sees is nearer; 0 of none. Beams diverge, so
 * each stands for more surface the farther it goes. The ground before a camera has most pixels, but
 * is not its surroundings. */
double medianDistance(const LabeledCloud& cloud) {
  std::vector<double> squares;
  for (const Eigen::Vector3f& p : cloud.points) squares.push_back(p.squaredNorm());
  std::sort(squares.begin(), squares.end());
  double left = std::accumulate(squares.begin(), squares.end(), 0.0) / 2;
  for (const double square : squares)
    if ((left -= square) <= 0) return std::sqrt(square);
  return 0;
}

}  // namespace

SensorScale SensorScale::of(const LabeledCloud& cloud, bool isPlanar) {
  if (isPlanar) return {true, 0.4, 8 * kDegree, 20, 0.05, {2, 1, 0.5}, 0.1, 10, 0.8};
  // Streets have a median of 11 m and more, rooms of 3 m. Powers of two: nearby medians act alike.
  constexpr double kStreet = 12;
  const double octaves = std::round(std::log2(std::max(medianDistance(cloud), 1e-3) / kStreet));
  const double size = std::exp2(std::clamp(octaves, -2., 0.));
  return {false,      0.8 * size, 15 * kDegree, 10, 0.25 * size, {2 * size, size},
          0.4 * size, 30 * size,  0.6};
}

std::vector<Submap> submapsOf(const LabeledCloud& cloud, const std::vector<double>& cells,
                              bool useClasses, bool isPlanar, double deviation) {
  std::vector<Submap> submaps;
  for (const double size : cells) {
    submaps.emplace_back(size, useClasses, isPlanar);
    submaps.back().add(cloud, Eigen::Isometry3d::Identity(), deviation);
    submaps.back().finish();
  }
  return submaps;
}

void LocalMap::add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_last_keyframe,
                   const SensorScale& scale, bool useClasses) {
  const auto most = static_cast<std::size_t>(scale.submapKeyframes);
  for (Part& part : m_parts) part.poses.push_back(rigid(part.poses.back() * T_last_keyframe));
  if (m_parts.empty() || (m_parts.size() == 1 && m_parts[0].poses.size() > most)) {
    m_parts.push_back(
        {submapsOf({}, scale.cells, useClasses, scale.isPlanar), {Eigen::Isometry3d::Identity()}});
  }
  for (Part& part : m_parts)
    for (Submap& submap : part.submaps) submap.add(cloud, part.poses.back());
  if (m_parts.front().poses.size() >= 2 * most) m_parts.pop_front();
  for (Submap& submap : m_parts.front().submaps) submap.finish();  // the others are not asked yet
}

}  // namespace semantic_slam
