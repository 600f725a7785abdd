#include "Reference.h"

#include <algorithm>
#include <cmath>

#include "SensorScale.h"

namespace semantic_slam {
namespace {

using semantic_octree::SemanticOcTree;

const std::vector<double> kCells = {8, 4, 2, 1};  // m

void addVoxels(const SemanticOcTree& map, const SemanticOcTree::leaf_iterator& leaf,
               LabeledCloud& cloud) {
  const double edge = map.getResolution();
  const int n = static_cast<int>(std::lround(leaf.getSize() / edge));
  const Eigen::Vector3d middle(leaf.getX(), leaf.getY(), leaf.getZ());
  const semantic_types::ClassId id = map.query(*leaf).likeliestClass;
  for (int i = 0; i < n * n * n; ++i) {
    const Eigen::Array3d voxel(i % n, i / n % n, i / n / n);
    cloud.points.push_back((middle + ((voxel + 0.5 - 0.5 * n) * edge).matrix()).cast<float>());
    cloud.classes.push_back(id);
  }
}

}  // namespace

Reference::Reference(const SemanticOcTree& map, bool useClasses)
    : m_voxelSize(map.getResolution()), m_useClasses(useClasses) {
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf)
    if (map.isNodeOccupied(*leaf) && leaf.getSize() <= kCells.back())
      addVoxels(map, leaf, m_voxels);
}

double Reference::deviation() const { return m_voxelSize / std::sqrt(12); }

auto Reference::layersOf(const LabeledCloud& scan, const Eigen::Isometry3d& T_map_scan) const
    -> Layers {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const Eigen::Vector3f& p : scan.points) {
    const double z = (T_map_scan * p.cast<double>()).z() / m_voxelSize;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  return {std::round(lowest) - 1, std::round(highest) + 1};
}

const std::vector<Submap>& Reference::submapsFor(const LabeledCloud& scan,
                                                 const Eigen::Isometry3d& T_map_scan,
                                                 bool isPlanar) {
  const Layers layers = isPlanar ? layersOf(scan, T_map_scan) : Layers(-HUGE_VAL, HUGE_VAL);
  if (layers == m_layers) return m_submaps;
  LabeledCloud cloud;
  for (std::size_t i = 0; i < m_voxels.size(); ++i) {
    const double z = m_voxels.points[i].z() / m_voxelSize;
    if (z < layers.first || z > layers.second) continue;
    cloud.points.push_back(m_voxels.points[i]);
    cloud.classes.push_back(m_voxels.classes[i]);
  }
  m_submaps = submapsOf(cloud, kCells, m_useClasses, isPlanar, deviation());
  m_layers = layers;
  return m_submaps;
}

}  // namespace semantic_slam
