#include <semantic_octree/SemanticOcTree.h>
#include <semantic_octree/store/MapAccess.h>
#include <semantic_octree/store/Scan.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <typeinfo>

namespace semantic_octree {
namespace {

double positive(double meters) {
  if (!(meters > 0) || !std::isfinite(meters))
    throw std::invalid_argument("resolution = " + std::to_string(meters) +
                                " m, expected a positive number");
  return meters;
}

/** \return an observer of both, whose bookkeeping can be compared; null: there is none */
const NodeObserver* observerOf(const SemanticOcTree& a, const SemanticOcTree& b) {
  const NodeObserver *x = MapAccess::observer(a), *y = MapAccess::observer(b);
  return x && y && typeid(*x) == typeid(*y) && x->stateBytes() == y->stateBytes() ? x : nullptr;
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
  const NodeStore& nodes = o.store();
  if (nodes.tiles()) nodes.tiles()->checkFits({});
  m_pruning = o.m_pruning;
  m_clock = o.m_clock;
  m_rule = o.m_rule;
  if (o.m_observer) m_observer = o.m_observer->clone();
  m_store = nodes.copy(nodes.stateBytes());
}

SemanticOcTree::SemanticOcTree(SemanticOcTree&& o)
    : SemanticOcTree(o.m_resolution, o.m_classes, o.m_parameters) {
  m_pruning = o.m_pruning;
  m_rule = o.m_rule;
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
  std::swap(m_rule, o.m_rule);
  std::swap(m_pruning, o.m_pruning);
  std::swap(m_clock, o.m_clock);
  std::swap(m_store, o.m_store);
  std::swap(m_observer, o.m_observer);
  std::swap(m_scan, o.m_scan);
  MapAccess::tellAll(*this);
  MapAccess::tellAll(o);
}

bool SemanticOcTree::operator==(const SemanticOcTree& o) const {
  if (m_resolution != o.m_resolution || m_classes != o.m_classes ||
      !(m_parameters == o.m_parameters) || m_pruning != o.m_pruning || m_clock != o.m_clock)
    return false;
  return areSame(store(), store().root(), o.store(), o.store().root(), observerOf(*this, o));
}

bool SemanticOcTree::isReadOnly() const { return store().tiles() && !store().tiles()->mayChange(); }

void SemanticOcTree::clear() {
  MapAccess::checkMayChange(*this);
  auto empty = std::make_unique<NodeStore>(m_observer ? m_observer->stateBytes() : 0);
  if (m_store) m_store->beginChanging(), m_store->endChanging();  // throws if it is read
  if (m_store && m_store->tiles()) {
    m_store->tiles()->clear();
    empty->setTiles(m_store->tiles());
  }
  MapAccess::setStore(*this, std::move(empty));
  m_clock = 0;
}

void SemanticOcTree::setPruning(bool on) {
  if (!empty()) throw std::logic_error("pruning can be switched in an empty tree only");
  m_pruning = on;
}

NodeStore& SemanticOcTree::store() const {
  if (!m_store)
    throw std::logic_error(
        "the map is broken: memory ran out, or a file failed, while it changed; clear it or load "
        "it anew");
  return *m_store;
}

std::size_t SemanticOcTree::size() const { return store().numNodes(); }

std::size_t SemanticOcTree::getNumLeafNodes() const {
  return store().numNodes() - store().numInnerNodes();
}

std::size_t SemanticOcTree::memoryUsage() const { return store().bytes(); }

void SemanticOcTree::age(double seconds) {
  store();
  MapAccess::ageUntil(*this, MapAccess::timeIn(*this, seconds));
}

void SemanticOcTree::setHalfLives(const ClassTable& table) {
  MapAccess::checkMayChange(*this);
  for (int i = 1; i <= numClasses(); ++i) {
    const auto id = static_cast<ClassId>(i);
    if (const auto same = table.find(m_classes.name(id)))
      m_classes.setHalfLife(id, table.halfLife(*same));
  }
  m_classes.setHalfLife(kNoClass, table.halfLife(kNoClass));
}

void SemanticOcTree::setCalibration(const Calibration& calibration) {
  FilterParameters parameters = m_parameters;
  parameters.calibration = calibration;
  setFilter(std::move(parameters));
}

void SemanticOcTree::setClassPrior(std::vector<float> prior) {
  FilterParameters parameters = m_parameters;
  parameters.classPrior = std::move(prior);
  setFilter(std::move(parameters));
}

void SemanticOcTree::setFilter(FilterParameters parameters) {
  m_filter = ClassFilter(numClasses(), parameters);
  m_parameters = std::move(parameters);
}

SemanticOcTree emptyLike(const SemanticOcTree& map) {
  return MapAccess::emptyWith(map, map.getResolution());
}

InsertionReport SemanticOcTree::insert(const LabeledCloud& cloud,
                                       const Eigen::Isometry3d& T_map_sensor,
                                       const InsertionOptions& options, double secondsSince) {
  options.validate();
  store();
  const std::int64_t time = MapAccess::timeIn(*this, secondsSince);
  if (!m_scan) m_scan = std::make_unique<Scan>();
  try {
    m_scan->set(cloud, T_map_sensor, m_resolution, m_filter, options);
    MapAccess::ageUntil(*this, time);
    MapAccess::merge(*this, *m_scan, options.threads);
  } catch (...) {
    m_scan = nullptr;  // half-filled buffers must not leak into the next scan
    throw;
  }
  const InsertionReport report = m_scan->report();
  if (m_scan->isLarge())
    m_scan = nullptr;
  else
    m_scan->clear();
  return report;
}

}  // namespace semantic_octree
