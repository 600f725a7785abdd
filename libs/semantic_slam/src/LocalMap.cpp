#include "LocalMap.h"

namespace semantic_slam {

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
