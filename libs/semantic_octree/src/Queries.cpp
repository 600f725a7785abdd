#include <semantic_octree/Keys.h>
#include <semantic_octree/MapContents.h>
#include <semantic_octree/SemanticOcTree.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "NodeStore.h"

namespace semantic_octree {
namespace {

/** Adds weight * distribution of the known leaves below a node. \return the weight that is known */
double addMixture(const SemanticOcTree& tree, const Node& node, double weight,
                  std::vector<double>& sum, std::vector<double>& scratch) {
  if (node.isLeaf()) {
    tree.belief(node).distribution(tree.numClasses(), scratch.data());
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * scratch[k];
    return weight;
  }
  double known = 0;
  for (int i = 0; i < 8; ++i)
    if (const Node* child = node.child(i))
      known += addMixture(tree, *child, weight / 8, sum, scratch);
  return known;
}

bool anyClassSeen(const Node& node) {
  if (node.isLeaf()) return node.hasClassRecord();
  for (int i = 0; i < 8; ++i)
    if (const Node* child = node.child(i); child && anyClassSeen(*child)) return true;
  return false;
}

/** Meters along a unit vector until the border of the map is near. */
double distanceToBorder(const octomap::point3d& origin, const octomap::point3d& direction,
                        double resolution) {
  double distance = HUGE_VAL;
  for (unsigned axis = 0; axis < 3; ++axis) {
    if (direction(axis) == 0) continue;
    const double border = std::copysign(kKeyOfOrigin * resolution, direction(axis));
    distance = std::min(distance, (border - origin(axis)) / direction(axis));
  }
  return distance - 2 * resolution;
}

}  // namespace

SemanticOcTree::Belief SemanticOcTree::belief(const Node& leaf) const {
  return leaf.hasClassRecord() ? m_store->record(leaf) : m_filter.uniform(leaf.getValue());
}

std::vector<double> SemanticOcTree::distribution(const Node& node) const {
  std::vector<double> p(numClasses() + 1, 0.0), scratch(p.size());
  const double known = addMixture(*this, node, 1.0, p, scratch);
  for (double& x : p) x /= known;
  return p;
}

CellState SemanticOcTree::query(const Node& node) const {
  CellState state;
  state.occupancy = octomap::probability(node.getValue());
  state.status = node.getValue() > 0 ? CellState::Status::Occupied : CellState::Status::Free;
  if (!anyClassSeen(node)) return state;
  const std::vector<double> p = distribution(node);
  const auto best = std::max_element(p.begin() + 1, p.end());
  state.likeliestClass = static_cast<ClassId>(best - p.begin());
  state.probability = *best;
  return state;
}

CellState SemanticOcTree::query(const octomap::OcTreeKey& key, unsigned depth) const {
  const Node* node = empty() ? nullptr : search(key, depth);
  return node ? query(*node) : CellState();
}

CellState SemanticOcTree::query(double x, double y, double z, unsigned depth) const {
  octomap::OcTreeKey key;
  return coordToKeyChecked(x, y, z, key) ? query(key, depth) : CellState();
}

std::optional<RayHit> SemanticOcTree::castRay(const octomap::point3d& origin,
                                              const octomap::point3d& direction, double maxRange,
                                              bool ignoreUnknown) const {
  const octomap::point3d unit = direction.normalized();
  if (!(unit.norm() > 0.5) || !std::isfinite(unit.norm()))
    throw std::invalid_argument("ray cast: a direction that is zero or not finite");
  octomap::OcTreeKey key;
  if (empty() || !coordToKeyChecked(origin, key)) return std::nullopt;
  // OctoMap prints a warning when a ray gets to the map's border, and so none may.
  const double inside = distanceToBorder(origin, unit, resolution);
  const double range = maxRange > 0 ? std::min(maxRange, inside) : inside;
  octomap::point3d end;
  if (range <= 0 || !Base::castRay(origin, unit, end, ignoreUnknown, range)) return std::nullopt;
  key = coordToKey(end);
  return RayHit{key, keyToCoord(key), query(key)};
}

MapContents contentsOf(const SemanticOcTree& tree) {
  MapContents contents;
  contents.bytes = tree.memoryUsage();
  contents.voxelsOfClass.assign(tree.numClasses() + 1, 0);
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    ++contents.leaves;
    const std::uint64_t voxels = std::uint64_t(1) << 3 * (tree.getTreeDepth() - leaf.getDepth());
    const Eigen::Vector3d center(leaf.getX(), leaf.getY(), leaf.getZ());
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(leaf.getSize() / 2);
    contents.box.extend(center - half).extend(center + half);
    const CellState state = tree.query(*leaf);
    if (state.status != CellState::Status::Occupied) {
      contents.freeVoxels += voxels;
      continue;
    }
    contents.occupiedVoxels += voxels;
    contents.voxelsOfClass[state.likeliestClass] += voxels;
  }
  contents.innerNodes = tree.size() - contents.leaves;
  return contents;
}

}  // namespace semantic_octree
