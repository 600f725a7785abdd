#include <semantic_octree/SemanticOcTree.h>

#include <algorithm>
#include <cmath>
#include <cstring>
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
    if (const Node child = node.child(i)) addTiles(child, cell.child(i), tiles);
}

/** Compares two trees slot by slot. */
class Comparison {
 public:
  Comparison(const NodeStore& a, const NodeStore& b, bool withState)
      : m_a(a), m_b(b), m_withState(withState) {}

  bool same(const Slot& a, const Slot& b) const {
    if (a.kind != b.kind || a.value != b.value) return false;
    switch (a.kind) {
      case Slot::Kind::None:
      case Slot::Kind::Leaf:
        return true;
      case Slot::Kind::LeafWithRecord:
        return m_a.record(a) == m_b.record(b);
      case Slot::Kind::Octant:
        return sameState(a, b) && sameChildren(m_a.octant(a), m_b.octant(b));
      case Slot::Kind::Block:
        return sameState(a, b) && sameVoxels(m_a.block(a), m_b.block(b));
    }
    return false;
  }

 private:
  bool sameChildren(const Octant& a, const Octant& b) const {
    for (int i = 0; i < 8; ++i)
      if (!same(a.slots[i], b.slots[i])) return false;
    return true;
  }
  bool sameVoxels(const Block& a, const Block& b) const {
    return a.known == b.known && a.leafOctants == b.leafOctants && a.recorded == b.recorded &&
           std::equal(a.values, a.values + 64, b.values) &&
           (!a.recorded ||
            std::equal(m_a.recordsOf(a), m_a.recordsOf(a) + a.numRecords(), m_b.recordsOf(b)));
  }
  /** What a node is, not what was told of it. */
  bool sameState(const Slot& a, const Slot& b) const {
    if (!m_withState) return true;
    const InnerState &x = *m_a.state<InnerState>(a), &y = *m_b.state<InnerState>(b);
    return x.density == y.density && x.gValue == y.gValue && x.isExpanded == y.isExpanded &&
           x.expandedOctants == y.expandedOctants &&
           std::memcmp(x.row(), y.row(), m_a.stateBytes() - sizeof(InnerState)) == 0;
  }

  const NodeStore &m_a, &m_b;
  bool m_withState;
};

}  // namespace

SemanticOcTree::SemanticOcTree(double voxelSize, ClassTable classes, const FilterParameters& filter)
    : m_resolution(positive(voxelSize)),
      m_classes(std::move(classes)),
      m_parameters(filter),
      m_filter(m_classes.size(), filter),
      m_store(std::make_unique<NodeStore>(0)) {}

SemanticOcTree::~SemanticOcTree() = default;

SemanticOcTree::SemanticOcTree(const SemanticOcTree& o)
    : SemanticOcTree(o.m_resolution, o.m_classes, o.m_parameters) {
  m_pruning = o.m_pruning;
  if (o.hasAbstraction()) {
    m_gTree = std::make_unique<GTree>(o.m_gTree->options(), m_filter, m_resolution);
    m_leafChanges = std::make_unique<LeafChanges>();
  }
  m_store = std::make_unique<NodeStore>(o.store(), o.store().stateBytes());
}

SemanticOcTree::SemanticOcTree(SemanticOcTree&& o)
    : SemanticOcTree(o.m_resolution, o.m_classes, o.m_parameters) {
  m_pruning = o.m_pruning;
  swap(o);
}

SemanticOcTree& SemanticOcTree::operator=(SemanticOcTree o) {
  swap(o);
  return *this;
}

void SemanticOcTree::swap(SemanticOcTree& o) {
  std::swap(m_resolution, o.m_resolution);
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
  if (m_resolution != o.m_resolution || m_classes != o.m_classes ||
      !(m_parameters == o.m_parameters) || m_pruning != o.m_pruning)
    return false;
  const bool sameRows = m_gTree && o.m_gTree && m_gTree->stateBytes() == o.m_gTree->stateBytes();
  return Comparison(store(), o.store(), sameRows).same(store().root(), o.store().root());
}

void SemanticOcTree::clear() {
  m_store = std::make_unique<NodeStore>(m_gTree ? m_gTree->stateBytes() : 0);
  if (m_touched) m_touched->take();
}

std::vector<octomap::OcTreeKey> SemanticOcTree::takeTouchedTiles() {
  if (!m_touched) {
    auto touched = std::make_unique<TouchedTiles>();
    if (!empty()) addTiles(root(), Cell(), *touched);
    m_touched = std::move(touched);
  }
  return m_touched->take();
}

void SemanticOcTree::setPruning(bool on) {
  if (!empty()) throw std::logic_error("pruning can be switched in an empty tree only");
  m_pruning = on;
}

void SemanticOcTree::setAbstraction(const AbstractionOptions& options) {
  options.validate(numClasses());
  auto gTree = std::make_unique<GTree>(options, m_filter, m_resolution);
  auto leafChanges = std::make_unique<LeafChanges>();
  auto newStore = std::make_unique<NodeStore>(store(), gTree->stateBytes());
  gTree->worker(0).recomputeAll(*newStore, newStore->root(), Cell());
  std::swap(m_gTree, gTree);
  std::swap(m_leafChanges, leafChanges);
  std::swap(m_store, newStore);
}

void SemanticOcTree::dropAbstraction() {
  m_store = std::make_unique<NodeStore>(store(), 0);
  m_gTree = nullptr;
  m_leafChanges = nullptr;
}

NodeStore& SemanticOcTree::store() const {
  if (!m_store)
    throw std::logic_error(
        "the map is broken: memory ran out while a scan was inserted; clear it or load it anew");
  return *m_store;
}

std::size_t SemanticOcTree::size() const { return store().numNodes(); }

std::size_t SemanticOcTree::getNumLeafNodes() const {
  return store().numNodes() - store().numInnerNodes();
}

std::size_t SemanticOcTree::memoryUsage() const { return store().bytes(); }

InsertionReport SemanticOcTree::insert(const LabeledCloud& cloud,
                                       const Eigen::Isometry3d& T_map_sensor,
                                       const InsertionOptions& options) {
  options.validate();
  NodeStore& nodes = store();
  if (!m_scan) m_scan = std::make_unique<Scan>();
  try {
    m_scan->set(cloud, T_map_sensor, m_resolution, numClasses(), options);
  } catch (...) {
    m_scan = nullptr;  // half-filled buffers must not leak into the next scan
    throw;
  }
  if (m_scan->hasVoxels()) {
    const MergeTarget target{nodes, m_filter, m_gTree.get(), m_touched.get(), m_pruning};
    try {
      mergeScan(target, *m_scan, options.threads);
    } catch (...) {
      m_store = nullptr;  // what is half inserted cannot be told from what was there
      m_scan = nullptr;
      throw;
    }
  }
  const InsertionReport report = m_scan->report();
  if (m_scan->bytes() > Scan::kTooManyBytes)
    m_scan = nullptr;
  else
    m_scan->clear();
  return report;
}

}  // namespace semantic_octree
