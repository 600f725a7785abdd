#include <semantic_octree/SemanticOcTree.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "Decay.h"
#include "NodeStore.h"
#include "Scan.h"
#include "ScanMerger.h"
#include "TileReplacement.h"
#include "TreeComparison.h"

namespace semantic_octree {
namespace {

double positive(double meters) {
  if (!(meters > 0) || !std::isfinite(meters))
    throw std::invalid_argument("resolution = " + std::to_string(meters) +
                                " m, expected a positive number");
  return meters;
}

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
  o.checkNotInTiles();
  m_pruning = o.m_pruning;
  m_clock = o.m_clock;
  if (o.hasAbstraction())
    m_gTree = std::make_unique<GTree>(o.m_gTree->options(), m_filter, m_resolution);
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
  std::swap(m_clock, o.m_clock);
  std::swap(m_store, o.m_store);
  std::swap(m_gTree, o.m_gTree);
  std::swap(m_scan, o.m_scan);
  tellAll();
  o.tellAll();
}

bool SemanticOcTree::operator==(const SemanticOcTree& o) const {
  if (m_resolution != o.m_resolution || m_classes != o.m_classes ||
      !(m_parameters == o.m_parameters) || m_pruning != o.m_pruning || m_clock != o.m_clock)
    return false;
  const bool sameRows = m_gTree && o.m_gTree && m_gTree->stateBytes() == o.m_gTree->stateBytes();
  return TreeComparison(store(), o.store(), sameRows).same(store().root(), o.store().root());
}

void SemanticOcTree::checkNotInTiles() const {
  if (m_store && m_store->tiles())
    throw std::logic_error(
        "a map in a folder of tiles cannot be copied, cleared, corrected or have half-lives");
}

bool SemanticOcTree::isReadOnly() const { return store().tiles() && !store().tiles()->mayChange(); }

void SemanticOcTree::clear() {
  checkNotInTiles();
  m_store = std::make_unique<NodeStore>(m_gTree ? m_gTree->stateBytes() : 0);
  m_clock = 0;
  tellAll();
}

void SemanticOcTree::tellAll() {
  m_tileLog.reset();
  m_leafLog.reset();
}

void SemanticOcTree::setPruning(bool on) {
  if (!empty()) throw std::logic_error("pruning can be switched in an empty tree only");
  m_pruning = on;
}

void SemanticOcTree::setAbstraction(const AbstractionOptions& options) {
  options.validate(numClasses());
  auto gTree = std::make_unique<GTree>(options, m_filter, m_resolution);
  auto newStore = storeFor(gTree->stateBytes());
  if (!store().tiles()) gTree->worker(0).recomputeAll(*newStore, newStore->root(), Cell());
  std::swap(m_gTree, gTree);
  m_leafLog.reset();
  m_store = std::move(newStore);  // first, so that tiles come in where the old nodes were
  if (store().tiles()) computeTileByTile();
}

std::unique_ptr<NodeStore> SemanticOcTree::storeFor(std::size_t stateBytes) const {
  if (!store().tiles()) return std::make_unique<NodeStore>(store(), stateBytes);
  store().tiles()->sendAway();
  return store().frame(stateBytes);
}

void SemanticOcTree::computeTileByTile() {
  try {
    m_gTree->worker(0).recomputeAll(store(), store().root(), Cell());
  } catch (...) {  // tiles came and went meanwhile: what was cannot be had back
    m_gTree = nullptr;
    throw;
  }
}

void SemanticOcTree::dropAbstraction() {
  m_store = storeFor(0);
  m_gTree = nullptr;
  m_leafLog.reset();
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

template <typename F>
void SemanticOcTree::change(const F& f) {
  const auto log = m_tileLog.lock();
  TileLog* const touched = log && log->isRead() ? log.get() : nullptr;
  const MergeTarget target{store(), m_filter, m_gTree.get(), touched, m_pruning};
  try {
    f(target);
  } catch (...) {
    m_store = nullptr;  // what is half changed cannot be told from what was there
    throw;
  }
}

void SemanticOcTree::merge(const Scan& scan, int threads) {
  if (!scan.hasVoxels()) return;
  if (store().tiles()) store().tiles()->prepare(scan);
  change([&](const MergeTarget& target) { mergeScan(target, scan, threads); });
}

std::int64_t SemanticOcTree::timeIn(double seconds) const {
  if (!(seconds >= 0 && seconds <= 1e9))
    throw std::invalid_argument("a map ages by 0 to 1000000000 s, not by " +
                                std::to_string(seconds) + " s");
  if (!m_classes.hasHalfLives()) return m_clock;
  const std::int64_t time = m_clock + std::llround(seconds * 1e9);
  if (time > kOldestMap) throw std::out_of_range("a map ages by no more than 200 years in all");
  return time;
}

void SemanticOcTree::age(double seconds) {
  store();
  ageUntil(timeIn(seconds));
}

void SemanticOcTree::ageUntil(std::int64_t time) {
  if (time == m_clock) return;
  std::vector<int> steps;
  for (int id = 0; id <= numClasses(); ++id)
    steps.push_back(decaySteps(m_classes.halfLife(static_cast<ClassId>(id)), m_clock, time));
  if (!empty() && std::any_of(steps.begin(), steps.end(), [](int n) { return n > 0; }))
    change([&](const MergeTarget& target) { decay(target, steps); });
  m_clock = time;
}

void SemanticOcTree::setHalfLives(const ClassTable& table) {
  checkNotInTiles();
  for (int i = 1; i <= numClasses(); ++i) {
    const auto id = static_cast<ClassId>(i);
    if (const auto same = table.find(m_classes.name(id)))
      m_classes.setHalfLife(id, table.halfLife(*same));
  }
  m_classes.setHalfLife(kNoClass, table.halfLife(kNoClass));
}

void SemanticOcTree::replace(const std::vector<std::uint64_t>& tiles,
                             const SemanticOcTree& source) {
  checkNotInTiles();
  change([&](const MergeTarget& target) { replaceTiles(target, tiles, source.store()); });
}

InsertionReport SemanticOcTree::insert(const LabeledCloud& cloud,
                                       const Eigen::Isometry3d& T_map_sensor,
                                       const InsertionOptions& options, double secondsSince) {
  options.validate();
  store();
  const std::int64_t time = timeIn(secondsSince);
  if (!m_scan) m_scan = std::make_unique<Scan>();
  try {
    m_scan->set(cloud, T_map_sensor, m_resolution, m_filter, options);
    ageUntil(time);
    merge(*m_scan, options.threads);
  } catch (...) {
    m_scan = nullptr;  // half-filled buffers must not leak into the next scan
    throw;
  }
  const InsertionReport report = m_scan->report();
  if (m_scan->bytes() > Scan::kTooManyBytes)
    m_scan = nullptr;
  else
    m_scan->clear();
  return report;
}

}  // namespace semantic_octree
