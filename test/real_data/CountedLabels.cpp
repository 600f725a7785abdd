#include "CountedLabels.h"

#include <semantic_types/ClassTable.h>

#include <algorithm>

ClassTable shippedTable(const std::string& name) {
  return semantic_types::loadClassTable(std::filesystem::path(MSO_SOURCE_DIR) / "config/classes" /
                                        name);
}

Voxel voxelOf(const SemanticOcTree& map, const LabeledFrame& frame, std::size_t point) {
  const Eigen::Vector3d p = frame.T_map_sensor * frame.cloud.points[point].cast<double>();
  return map.coordToKey(p.x(), p.y(), p.z());
}

ClassId CountedLabels::at(const Voxel& voxel, double neighborWeight) const {
  std::map<ClassId, double> sum;
  const auto add = [&](const Voxel& v, double weight) {
    const auto found = m_counts.find(v);
    if (found == m_counts.end()) return;
    for (const auto& [id, count] : found->second) sum[id] += weight * count;
  };
  add(voxel, 1);
  for (unsigned axis = 0; axis < 3 && neighborWeight > 0; ++axis)
    for (const int step : {-1, 1}) {
      Voxel neighbor = voxel;
      neighbor[axis] = static_cast<octomap::key_type>(neighbor[axis] + step);
      add(neighbor, neighborWeight);
    }
  const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
  return sum.empty() ? kNoClass : std::max_element(sum.begin(), sum.end(), fewer)->first;
}
