#include <semantic_octree/SemanticOcTree.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "CompressedTree.h"
#include "NodeStore.h"
#include "Scan.h"
#include "ScanMerger.h"
#include "TouchedTiles.h"

namespace semantic_octree {
namespace {

double positive(double meters) {
  if (!(meters > 0) || !std::isfinite(meters))
    throw std::invalid_argument("resolution = " + std::to_string(meters) +
                                " m, expected a positive number");
  return meters;
}

/** Adds the tiles below a node. */
void addTiles(const Node& node, const Cell& cell, TouchedTiles& tiles) {
  if (node.isLeaf() || cell.depth == TouchedTiles::kDepth) return tiles.add(cell);
  for (int i = 0; i < 8; ++i)
    if (const Node* child = node.child(i)) addTiles(*child, cell.child(i), tiles);
}

/** Compares two trees node by node. */
class Comparison {
 public:
  Comparison(const NodeStore& a, const NodeStore& b, const GTree* gTree)
      : m_a(a), m_b(b), m_gTree(gTree) {}

  bool same(const Node& a, const Node& b) const {
    if (a.isLeaf() != b.isLeaf() || a.getValue() != b.getValue()) return false;
    if (!a.isLeaf()) return sameState(a, b) && sameChildren(a, b);
    return a.hasClassRecord() == b.hasClassRecord() &&
           (!a.hasClassRecord() || m_a.record(a) == m_b.record(b));
  }

 private:
  bool sameChildren(const Node& a, const Node& b) const {
    for (int i = 0; i < 8; ++i) {
      const Node *childA = a.child(i), *childB = b.child(i);
      if (!childA != !childB || (childA && !same(*childA, *childB))) return false;
    }
    return true;
  }
  /** What a node is, not what was told of it. */
  bool sameState(const Node& a, const Node& b) const {
    if (!m_gTree) return true;
    const InnerState &x = *m_a.state<InnerState>(a), &y = *m_b.state<InnerState>(b);
    return x.density == y.density && x.gValue == y.gValue && x.splitEntropy == y.splitEntropy &&
           x.isExpanded == y.isExpanded &&
           std::memcmp(x.row(), y.row(), m_gTree->stateBytes() - sizeof(InnerState)) == 0;
  }

  const NodeStore &m_a, &m_b;
  const GTree* m_gTree;
};

}  // namespace

SemanticOcTree::SemanticOcTree(double voxelSize, ClassTable classes, const FilterParameters& filter)
    : Base(positive(voxelSize)),
      m_classes(std::move(classes)),
      m_parameters(filter),
      m_filter(m_classes.size(), filter),
      m_store(std::make_unique<NodeStore>(0)),
      m_scan(std::make_unique<Scan>()) {
  // OctoMap counts what equals the threshold as occupied; here even odds are not.
  occ_prob_thres_log = std::numeric_limits<float>::min();
  clearKeyRays();  // OctoMap keeps a large buffer for an insertion that is not used here
}

SemanticOcTree::~SemanticOcTree() { Base::root = nullptr; }

SemanticOcTree::SemanticOcTree(const SemanticOcTree& o)
    : SemanticOcTree(o.resolution, o.m_classes, o.m_parameters) {
  m_pruning = o.m_pruning;
  if (o.hasAbstraction()) setAbstraction(o.m_gTree->options());
  if (o.empty()) return;
  m_store->arena(0).copy(*o.m_store, *o.root(), m_store->root());
  attachRoot();
}

SemanticOcTree::SemanticOcTree(SemanticOcTree&& o)
    : SemanticOcTree(o.resolution, o.m_classes, o.m_parameters) {
  m_pruning = o.m_pruning;
  swap(o);
}

SemanticOcTree& SemanticOcTree::operator=(SemanticOcTree o) {
  swap(o);
  return *this;
}

void SemanticOcTree::swap(SemanticOcTree& o) {
  const double resolutionBefore = resolution;
  Base::setResolution(o.resolution);
  o.Base::setResolution(resolutionBefore);
  std::swap(Base::root, o.Base::root);
  std::swap(tree_size, o.tree_size);
  size_changed = o.size_changed = true;
  std::swap(m_classes, o.m_classes);
  std::swap(m_parameters, o.m_parameters);
  std::swap(m_filter, o.m_filter);
  std::swap(m_pruning, o.m_pruning);
  std::swap(m_store, o.m_store);
  std::swap(m_gTree, o.m_gTree);
  std::swap(m_leafChanges, o.m_leafChanges);
  std::swap(m_touched, o.m_touched);
  std::swap(m_scan, o.m_scan);
}

bool SemanticOcTree::operator==(const SemanticOcTree& o) const {
  if (resolution != o.resolution || m_classes != o.m_classes || !(m_parameters == o.m_parameters) ||
      m_pruning != o.m_pruning || empty() != o.empty() || size() != o.size())
    return false;
  const bool sameRows = m_gTree && o.m_gTree && m_gTree->stateBytes() == o.m_gTree->stateBytes();
  return empty() || Comparison(*m_store, *o.m_store, sameRows ? m_gTree.get() : nullptr)
                        .same(*root(), *o.root());
}

void SemanticOcTree::clear() {
  Base::root = nullptr;
  m_store = std::make_unique<NodeStore>(m_store->stateBytes());
  if (m_touched) m_touched->take();
  tree_size = 0;
  size_changed = true;
}

std::vector<octomap::OcTreeKey> SemanticOcTree::takeTouchedTiles() {
  if (!m_touched) {
    m_touched = std::make_unique<TouchedTiles>();
    if (!empty()) addTiles(*root(), Cell(), *m_touched);
  }
  return m_touched->take();
}

void SemanticOcTree::setPruning(bool on) {
  if (!empty()) throw std::logic_error("pruning can be switched in an empty tree only");
  m_pruning = on;
}

void SemanticOcTree::setAbstraction(const AbstractionOptions& options) {
  options.validate(numClasses());
  m_gTree = std::make_unique<GTree>(options, m_filter, resolution);
  m_leafChanges = std::make_unique<LeafChanges>();
  rebuildStore();
  if (!empty()) m_gTree->worker(0).recomputeAll(*m_store, m_store->root(), Cell());
}

void SemanticOcTree::dropAbstraction() {
  m_gTree = nullptr;
  m_leafChanges = nullptr;
  rebuildStore();
}

void SemanticOcTree::rebuildStore() {
  auto store = std::make_unique<NodeStore>(m_gTree ? m_gTree->stateBytes() : 0);
  if (!empty()) store->arena(0).copy(*m_store, *root(), store->root());
  std::swap(m_store, store);
  if (!empty()) attachRoot();
}

std::size_t SemanticOcTree::getNumLeafNodes() const {
  return empty() ? 0 : m_store->numNodes() - m_store->numInnerNodes();
}

std::size_t SemanticOcTree::memoryUsage() const { return m_store->bytes(); }

InsertionReport SemanticOcTree::insert(const LabeledCloud& cloud,
                                       const Eigen::Isometry3d& T_map_sensor,
                                       const InsertionOptions& options) {
  options.validate();
  try {
    m_scan->set(cloud, T_map_sensor, resolution, numClasses(), options);
  } catch (...) {
    m_scan = std::make_unique<Scan>();  // half-filled buffers must not leak into the next scan
    throw;
  }
  if (m_scan->hasVoxels()) {
    const MergeTarget target{*m_store, m_filter, m_gTree.get(), m_touched.get(), m_pruning};
    mergeScan(target, *m_scan, m_store->root(), empty(), options.threads);
    attachRoot();
  }
  m_scan->clear();
  return m_scan->report();
}

void SemanticOcTree::attachRoot() {
  Base::root = &m_store->root();
  tree_size = m_store->numNodes();
  size_changed = true;
}

}  // namespace semantic_octree
