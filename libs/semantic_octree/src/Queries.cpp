#include <semantic_octree/Keys.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_octree/store/LeafContent.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace semantic_octree {
namespace {

/** Adds weight * distribution of the known leaves below a node. \return the weight that is known */
double addMixture(const SemanticOcTree& tree, const ClassFilter& filter, const Node& node,
                  double weight, std::vector<double>& sum, std::vector<double>& scratch) {
  if (node.isLeaf()) {
    filter.distribution(tree.belief(node), scratch.data());
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * scratch[k];
    return weight;
  }
  double known = 0;
  for (int i = 0; i < 8; ++i)
    if (const Node child = node.child(i))
      known += addMixture(tree, filter, child, weight / 8, sum, scratch);
  return known;
}

/** Widens a box (keys, ends included) to all known cells below a node. */
void addExtent(const Node& node, const Cube& cell, VoxelIndex& low, VoxelIndex& high) {
  const VoxelIndex first = cell.lowest, last = first + (cell.edge() - 1);
  if ((first >= low).all() && (last <= high).all()) return;
  if (node.isLeaf()) {
    low = low.min(first);
    high = high.max(last);
    return;
  }
  for (int i = 0; i < 8; ++i)
    if (const Node child = node.child(i)) addExtent(child, cell.child(i), low, high);
}

}  // namespace

SemanticOcTree::Belief SemanticOcTree::belief(const Node& leaf) const {
  return leaf.hasClassRecord() ? NodeStore::record(leaf).belief()
                               : m_filter.uniform(leaf.getLogOdds());
}

std::vector<double> SemanticOcTree::distribution(const Node& node) const {
  std::vector<double> p(numClasses() + 1, 0.0);
  if (node.isLeaf()) {
    m_filter.distribution(belief(node), p.data());
    return p;
  }
  std::vector<double> scratch(p.size());
  const double known = addMixture(*this, m_filter, node, 1.0, p, scratch);
  for (double& x : p) x /= known;
  return p;
}

CellState SemanticOcTree::query(const Node& node) const {
  CellState state;
  state.occupancy = node.getOccupancy();
  state.status = isNodeOccupied(node) ? CellState::Status::Occupied : CellState::Status::Free;
  if (node.isLeaf()) {
    if (!node.hasClassRecord()) return state;
    const std::vector<double> p = distribution(node);
    const auto best = std::max_element(p.begin() + 1, p.end());
    state.likeliestClass = static_cast<ClassId>(best - p.begin());
    state.probability = *best;
    return state;
  }
  const std::vector<double> shares = classShares(node, m_filter);
  if (shares.empty()) return state;
  const auto best = std::max_element(shares.begin(), shares.end());
  state.likeliestClass = static_cast<ClassId>(best - shares.begin() + 1);
  state.probability = state.occupancy * *best;
  return state;
}

CellState SemanticOcTree::query(const octomap::OcTreeKey& key, unsigned depth) const {
  const Node node = search(key, depth);
  return node ? query(node) : CellState();
}

CellState SemanticOcTree::query(double x, double y, double z, unsigned depth) const {
  octomap::OcTreeKey key;
  return coordToKeyChecked(x, y, z, key) ? query(key, depth) : CellState();
}

Node SemanticOcTree::root() const { return store().rootNode(); }

Node SemanticOcTree::search(const octomap::OcTreeKey& key, unsigned depth) const {
  Node node = root();
  const int last = depth == 0 ? kTreeDepth : static_cast<int>(depth);
  for (int d = 0; node && d < last && !node.isLeaf(); ++d) {
    const int bit = kTreeDepth - 1 - d;
    node = node.child((key[0] >> bit & 1) | (key[1] >> bit & 1) << 1 | (key[2] >> bit & 1) << 2);
  }
  return node;
}

TreeIterator SemanticOcTree::begin_leafs(unsigned maxDepth) const {
  TreeIterator::Selection selection;
  if (maxDepth > 0) selection.maxDepth = static_cast<int>(maxDepth);
  return {*this, selection};
}

TreeIterator SemanticOcTree::begin_tree(unsigned maxDepth) const {
  TreeIterator::Selection selection;
  selection.innerNodes = true;
  if (maxDepth > 0) selection.maxDepth = static_cast<int>(maxDepth);
  return {*this, selection};
}

TreeIterator SemanticOcTree::begin_leafs_bbx(const octomap::OcTreeKey& low,
                                             const octomap::OcTreeKey& high,
                                             unsigned maxDepth) const {
  TreeIterator::Selection selection;
  if (maxDepth > 0) selection.maxDepth = static_cast<int>(maxDepth);
  selection.low = low;
  selection.high = high;
  return {*this, selection};
}

TreeIterator SemanticOcTree::begin_leafs_bbx(const octomap::point3d& low,
                                             const octomap::point3d& high,
                                             unsigned maxDepth) const {
  octomap::OcTreeKey lowKey, highKey;
  if (!coordToKeyChecked(low, lowKey) || !coordToKeyChecked(high, highKey)) return {};
  return begin_leafs_bbx(lowKey, highKey, maxDepth);
}

octomap::OcTreeKey SemanticOcTree::coordToKey(double x, double y, double z) const {
  return octomapKey(keyOf(x, m_resolution), keyOf(y, m_resolution), keyOf(z, m_resolution));
}
octomap::OcTreeKey SemanticOcTree::coordToKey(const octomap::point3d& point) const {
  return coordToKey(point.x(), point.y(), point.z());
}

bool SemanticOcTree::coordToKeyChecked(double x, double y, double z,
                                       octomap::OcTreeKey& key) const {
  for (const double coordinate : {x, y, z}) {
    const double voxel = inVoxels(coordinate, m_resolution);
    if (!(voxel >= -kKeyOfOrigin) || !(voxel < kKeyOfOrigin)) return false;
  }
  key = coordToKey(x, y, z);
  return true;
}
bool SemanticOcTree::coordToKeyChecked(const octomap::point3d& point,
                                       octomap::OcTreeKey& key) const {
  return coordToKeyChecked(point.x(), point.y(), point.z(), key);
}

octomap::point3d SemanticOcTree::keyToCoord(const octomap::OcTreeKey& key, unsigned depth) const {
  const auto center = [&](unsigned axis) {
    return static_cast<float>(centerOf(key[axis], m_resolution, static_cast<int>(depth)));
  };
  return {center(0), center(1), center(2)};
}

void SemanticOcTree::getMetricMin(double& x, double& y, double& z) const {
  VoxelIndex low = VoxelIndex::Constant(kNumKeys), high = VoxelIndex::Constant(-1);
  if (empty()) return void(x = y = z = 0);
  addExtent(root(), Cube(), low, high);
  x = lowerBorderOf(low.x(), m_resolution);
  y = lowerBorderOf(low.y(), m_resolution);
  z = lowerBorderOf(low.z(), m_resolution);
}

void SemanticOcTree::getMetricMax(double& x, double& y, double& z) const {
  VoxelIndex low = VoxelIndex::Constant(kNumKeys), high = VoxelIndex::Constant(-1);
  if (empty()) return void(x = y = z = 0);
  addExtent(root(), Cube(), low, high);
  x = lowerBorderOf(high.x() + 1, m_resolution);
  y = lowerBorderOf(high.y() + 1, m_resolution);
  z = lowerBorderOf(high.z() + 1, m_resolution);
}

namespace {

/** The voxels along a ray, one after the other (Amanatides, Woo, "A Fast Voxel Traversal Algorithm
 * for Ray Tracing"). */
class VoxelWalk {
 public:
  VoxelWalk(const SemanticOcTree& tree, const octomap::point3d& origin,
            const octomap::point3d& direction) {
    const double voxel = tree.getResolution();
    const octomap::OcTreeKey first = tree.coordToKey(origin);
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double o = origin(axis), d = direction(axis);
      m_key[axis] = first[axis];
      m_step[axis] = d > 0 ? 1 : d < 0 ? -1 : 0;
      const double border = centerOf(m_key[axis], voxel) + 0.5 * m_step[axis] * voxel;
      m_next[axis] = m_step[axis] == 0 ? HUGE_VAL : (border - o) / d;
      m_perVoxel[axis] = m_step[axis] == 0 ? HUGE_VAL : voxel / std::fabs(d);
    }
  }

  bool isInside() const {
    for (const int key : m_key)
      if (key < 0 || key >= kNumKeys) return false;
    return true;
  }
  octomap::OcTreeKey key() const { return octomapKey(m_key[0], m_key[1], m_key[2]); }
  /** Along the direction, where the present voxel is left. */
  double leftAt() const { return std::min(m_next[0], std::min(m_next[1], m_next[2])); }
  void step() {
    int axis = m_next[0] < m_next[1] ? 0 : 1;
    if (!(m_next[axis] < m_next[2])) axis = 2;
    m_key[axis] += m_step[axis];
    m_next[axis] += m_perVoxel[axis];
  }

 private:
  int m_key[3], m_step[3];
  double m_next[3], m_perVoxel[3];
};

}  // namespace

bool SemanticOcTree::computeRayKeys(const octomap::point3d& origin, const octomap::point3d& end,
                                    octomap::KeyRay& ray) const {
  ray.reset();
  octomap::OcTreeKey key, last;
  if (!coordToKeyChecked(origin, key) || !coordToKeyChecked(end, last)) return false;
  for (VoxelWalk walk(*this, origin, end - origin); walk.isInside(); walk.step()) {
    if (walk.key() == last || !(walk.leftAt() <= 1)) break;
    ray.addKey(walk.key());
  }
  return true;
}

std::optional<RayHit> SemanticOcTree::castRay(const octomap::point3d& origin,
                                              const octomap::point3d& direction, double maxRange,
                                              bool ignoreUnknown) const {
  const octomap::point3d unit = direction.normalized();
  if (!(unit.norm() > 0.5) || !std::isfinite(unit.norm()))
    throw std::invalid_argument("ray cast: a direction that is zero or not finite");
  octomap::OcTreeKey key;
  if (empty() || !coordToKeyChecked(origin, key)) return std::nullopt;
  bool isFirst = true;
  for (VoxelWalk walk(*this, origin, unit); walk.isInside(); walk.step()) {
    const octomap::point3d center = keyToCoord(walk.key());
    if (!isFirst && maxRange > 0 && (center - origin).norm() > maxRange) break;
    isFirst = false;
    const Node node = search(walk.key());
    if (!node && !ignoreUnknown) break;
    if (node && isNodeOccupied(node)) return RayHit{walk.key(), center, query(node)};
  }
  return std::nullopt;
}

}  // namespace semantic_octree
