#include <semantic_octree/SemanticOcTree.h>

#include <algorithm>

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
    if (const Node* child = NodeStore::child(node, i))
      known += addMixture(tree, *child, weight / 8, sum, scratch);
  return known;
}

bool anyClassSeen(const Node& node) {
  if (node.isLeaf()) return node.hasClassRecord();
  for (int i = 0; i < 8; ++i)
    if (const Node* child = NodeStore::child(node, i); child && anyClassSeen(*child)) return true;
  return false;
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
  octomap::point3d end;
  if (empty() || !Base::castRay(origin, direction, end, ignoreUnknown, maxRange))
    return std::nullopt;
  const octomap::OcTreeKey key = coordToKey(end);
  return RayHit{key, keyToCoord(key), query(key)};
}

}  // namespace semantic_octree
