#include <semantic_slam/Reference.h>

#include <algorithm>
#include <cmath>

namespace semantic_slam {
namespace {

using semantic_octree::SemanticOcTree;

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

std::vector<Submap> referenceOf(const SemanticOcTree& map, const std::vector<double>& cellSizes,
                                bool useClasses) {
  const double largest = *std::min_element(cellSizes.begin(), cellSizes.end());
  LabeledCloud cloud;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf)
    if (map.isNodeOccupied(*leaf) && leaf.getSize() <= largest) addVoxels(map, leaf, cloud);
  std::vector<Submap> submaps;
  for (const double size : cellSizes) {
    submaps.emplace_back(size, useClasses);
    submaps.back().add(cloud, Eigen::Isometry3d::Identity());
    submaps.back().finish();
  }
  return submaps;
}

double deviationOfVoxels(double voxelSize) { return voxelSize / std::sqrt(12); }

}  // namespace semantic_slam
