#include <semantic_octree/SemanticOcTree.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "AbstractionUpkeep.h"
#include "NodeStore.h"
#include "ReportedTree.h"
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
    if (const Node* child = NodeStore::child(node, i)) addTiles(*child, cell.child(i), tiles);
}

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
  if (o.hasAbstraction()) setAbstraction(o.m_upkeep->options());
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
  std::swap(m_upkeep, o.m_upkeep);
  std::swap(m_reported, o.m_reported);
  std::swap(m_touched, o.m_touched);
  std::swap(m_scan, o.m_scan);
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
  m_upkeep = std::make_unique<AbstractionUpkeep>(options, m_filter, resolution);
  m_reported = std::make_unique<ReportedTree>();
  rebuildStore();
  if (!empty()) m_upkeep->worker(0).recomputeAll(*m_store, m_store->root(), Cell());
}

void SemanticOcTree::dropAbstraction() {
  m_upkeep = nullptr;
  m_reported = nullptr;
  rebuildStore();
}

void SemanticOcTree::rebuildStore() {
  auto store = std::make_unique<NodeStore>(m_upkeep ? m_upkeep->stateBytes() : 0);
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
    const MergeTarget target{*m_store, m_filter, m_upkeep.get(), m_touched.get(), m_pruning};
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
