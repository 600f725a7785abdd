#include "NearestOccupied.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace semantic_map {

using semantic_octree::SemanticOcTree;

NearestOccupied::NearestOccupied(const SemanticOcTree& tree, Distance distance)
    : m_tree(tree), m_weights(1, 1, distance == Distance::InSpace ? 1 : 0) {}

std::optional<NearestOccupied::Voxel> NearestOccupied::operator()(const Eigen::Vector3d& point,
                                                                  double within) const {
  std::optional<Voxel> best;
  if (m_tree.empty()) return best;
  const double size = m_tree.getNodeSize(0);
  double bound = within * within;
  descend({m_tree.root(), Eigen::Vector3d::Constant(-size / 2), size}, point, bound, best);
  return best;
}

NearestOccupied::Voxel NearestOccupied::nearestIn(const Cube& cube,
                                                  const Eigen::Vector3d& point) const {
  const double voxel = m_tree.getResolution();
  const double last = std::round(cube.size / voxel) - 1;
  const auto index = [&](double offset) {
    return std::clamp(std::floor(offset / voxel), 0.0, last) + 0.5;
  };
  const Eigen::Vector3d center = cube.low + voxel * (point - cube.low).unaryExpr(index);
  return {center, (center - point).cwiseAbs2().dot(m_weights)};
}

void NearestOccupied::descend(const Cube& cube, const Eigen::Vector3d& point, double& bound,
                              std::optional<Voxel>& best) const {
  const Voxel voxel = nearestIn(cube, point);
  if (!m_tree.isNodeOccupied(cube.node) || !(voxel.squaredDistance < bound)) return;
  if (cube.node.isLeaf()) {
    best = voxel;
    bound = voxel.squaredDistance;
    return;
  }
  using Child = std::pair<double, Cube>;
  std::array<Child, 8> children;
  const auto nearer = [](const Child& a, const Child& b) { return a.first < b.first; };
  auto end = children.begin();
  for (int i = 0; i < 8; ++i) {
    const auto node = cube.node.child(i);
    if (!node) continue;
    const double half = cube.size / 2;
    const Cube child{node, cube.low + half * Eigen::Vector3d(i & 1, i >> 1 & 1, i >> 2 & 1), half};
    *end = {nearestIn(child, point).squaredDistance, child};
    std::rotate(std::upper_bound(children.begin(), end, *end, nearer), end, end + 1);
    ++end;
  }
  for (auto child = children.begin(); child != end; ++child)
    descend(child->second, point, bound, best);
}

}  // namespace semantic_map
