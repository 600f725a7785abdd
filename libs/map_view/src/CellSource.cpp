#include <map_view/CellSource.h>

#include <map_view/LiveCompression.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_types/ClassTable.h>
#include <tree_abstraction/Information.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace map_view {

using semantic_octree::CellState;
using semantic_octree::SemanticOcTreeNode;

namespace {

/** Without a node. */
ViewCell unknownChild(const ViewCell& parent, int i) { return {parent.child(i), {}}; }

/** A leaf of a map is a leaf. */
struct MapNode {
  ViewCell cell;

  explicit MapNode(const SemanticOcTree& map)
      : cell{Cube(), map.empty() ? SemanticOcTreeNode() : map.root()} {}
  MapNode(const MapNode& parent, int i) : cell(unknownChild(parent.cell, i)) {
    cell.node = parent.cell.node.child(i);
  }

  bool isLeaf() const { return cell.node.isLeaf(); }
  /** Calls f(child) for the known children. */
  template <class F>
  void forEachChild(const F& f) const {
    for (int i = 0; i < 8; ++i) {
      const MapNode child(*this, i);
      if (child.cell.node) f(child);
    }
  }
};

/** Inner nodes that the compressed tree does not expand are cells, too. */
struct CompressedNode : MapNode {
  const LiveCompression* compression;
  LiveCompression::Index index = 0;  ///< of an inner node of the map

  CompressedNode(const SemanticOcTree& map, const LiveCompression& live)
      : MapNode(map), compression(&live) {
    mark();
  }

  bool isLeaf() const { return cell.node.isLeaf() || !compression->isExpanded(index); }
  template <class F>
  void forEachChild(const F& f) const {
    LiveCompression::Index next = index + 1;
    for (int i = 0; i < 8; ++i) {
      const CompressedNode child(*this, i, next);
      if (!child.cell.node) continue;
      if (!child.cell.node.isLeaf()) next = compression->end(next);
      f(child);
    }
  }

 private:
  CompressedNode(const CompressedNode& parent, int i, LiveCompression::Index at)
      : MapNode(parent, i), compression(parent.compression), index(at) {
    cell.around = parent.cell.around;
    mark();
  }
  void mark() {
    if (!cell.node || cell.node.isLeaf()) return;
    cell.innerNode = std::uint64_t(index) + 1;
    cell.around = index;
  }
};

template <class Node>
class Walk {
 public:
  Walk(const KeyBox& box, int maxDepth, const CellLook& look, const CellSource::Visit& visit)
      : m_box(box), m_bounds(look.bounds()), m_maxDepth(maxDepth), m_look(look), m_visit(visit) {}

  void walk(const Node& node) const {
    const ViewCell& cell = node.cell;
    if (!m_box.meets(cell)) return;
    const bool free = m_look.style().freeSpace, unknown = m_look.style().unknownSpace;
    if (!cell.isOccupied() && !free && !unknown) return;  // nor is what is below it
    if (node.isLeaf()) {
      if (m_look.isShown(cell)) m_visit(cell);
    } else if (cell.depth == m_maxDepth) {
      ViewCell shown = cell;
      if (findShown(node, true, shown) || (free && findShown(node, false, shown))) m_visit(shown);
    } else {
      node.forEachChild([this](const Node& child) { walk(child); });
      if (unknown) forEachUnknownChild(cell, [this](const ViewCell& child) { walkUnknown(child); });
    }
  }

 private:
  template <class F>
  static void forEachUnknownChild(const ViewCell& cell, const F& f) {
    for (int i = 0; i < 8; ++i)
      if (!cell.node.child(i)) f(unknownChild(cell, i));
  }

  /** The largest cubes that lie within the bounds. */
  void walkUnknown(const ViewCell& cell) const {
    if (!m_box.meets(cell) || !m_bounds.meets(cell)) return;
    if (cell.depth == m_maxDepth || m_bounds.contains(cell)) {
      if (m_look.isShown(cell)) m_visit(cell);
    } else {
      for (int i = 0; i < 8; ++i) walkUnknown(unknownChild(cell, i));
    }
  }

  /** A leaf below a node that is shown: from its upper half, if there is one. */
  bool findShown(const Node& node, bool occupied, ViewCell& shown) const {
    if (occupied && !node.cell.isOccupied()) return false;
    if (node.isLeaf()) {
      if (node.cell.isOccupied() != occupied || !m_look.isShown(node.cell)) return false;
      shown.node = node.cell.node, shown.innerNode = node.cell.innerNode;
      return true;
    }
    std::array<std::optional<Node>, 8> children;
    std::size_t number = 0;
    node.forEachChild([&](const Node& child) { children[number++] = child; });
    while (number > 0)
      if (findShown(*children[--number], occupied, shown)) return true;
    return false;
  }

  const KeyBox& m_box;
  const KeyBox m_bounds;
  int m_maxDepth;
  const CellLook& m_look;
  const CellSource::Visit& m_visit;
};

template <class Node>
ViewCell leafAt(const Eigen::Array3i& key, const Node& root) {
  if (!root.cell.node) return root.cell;
  Node node = root;
  while (!node.isLeaf()) {
    std::optional<Node> next;
    node.forEachChild([&](const Node& child) {
      if (child.cell.contains(key)) next = child;
    });
    if (!next) return unknownChild(node.cell, node.cell.childAt(key));
    node = *next;
  }
  return node.cell;
}

}  // namespace

void forEachOccupiedLeaf(const SemanticOcTree& map, const CellSource::Visit& f) {
  const auto walk = [&](const auto& self, const MapNode& node) -> void {
    if (!node.cell.isOccupied()) return;
    if (node.isLeaf()) return f(node.cell);
    node.forEachChild([&](const MapNode& child) { self(self, child); });
  };
  walk(walk, MapNode(map));
}

void CellSource::forEachShown(const KeyBox& box, int maxDepth, const CellLook& look,
                              const Visit& visit) const {
  if (m_map->empty()) return;
  if (m_compression)
    Walk<CompressedNode>(box, maxDepth, look, visit).walk(CompressedNode(*m_map, *m_compression));
  else
    Walk<MapNode>(box, maxDepth, look, visit).walk(MapNode(*m_map));
}

ViewCell CellSource::at(const Eigen::Array3i& key) const {
  return m_compression ? leafAt(key, CompressedNode(*m_map, *m_compression))
                       : leafAt(key, MapNode(*m_map));
}

CellAnswer answerOf(const ViewCell& cell, const SemanticOcTree& map) {
  constexpr double kLeast = 0.0005;
  CellAnswer answer;
  const double voxel = map.getResolution();
  answer.key = semantic_octree::octomapKey(cell.lowest.x(), cell.lowest.y(), cell.lowest.z());
  answer.center = cell.center(voxel);
  answer.size = map.getNodeSize(static_cast<unsigned>(cell.depth));
  answer.state = "unknown", answer.occupancy = 0.5;
  if (!cell.node) return answer;
  const CellState state = map.query(cell.node);
  answer.occupancy = state.occupancy;
  answer.state = state.status == CellState::Status::Free
                     ? "free"
                     : "occupied, " + map.classes().name(state.likeliestClass);
  const std::vector<double> p = map.distribution(cell.node);
  for (std::size_t k = 0; k < p.size(); ++k)
    if (p[k] >= kLeast)
      answer.shares.push_back(
          {k == 0 ? semantic_octree::kFreeSpace : map.classes().name(static_cast<ClassId>(k)),
           static_cast<ClassId>(k), p[k]});
  std::stable_sort(answer.shares.begin(), answer.shares.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  return answer;
}

using semantic_types::trafficLight;
using tree_abstraction::relativeEntropy;

namespace {

constexpr Color kFree{120, 180, 235}, kUnknown{60, 55, 50};

std::uint8_t toByte(double x) { return static_cast<std::uint8_t>(x + 0.5); }

/** From dark violet (0) over blue and green to yellow (1), brighter and brighter. */
Color ramp(double value) {
  constexpr std::array<std::array<double, 3>, 5> kStops = {
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
  const double at = std::clamp(value, 0.0, 1.0) * (kStops.size() - 1);
  const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(at), kStops.size() - 2);
  const auto mixed = [&](std::size_t c) {
    return toByte(kStops[i][c] + (at - double(i)) * (kStops[i + 1][c] - kStops[i][c]));
  };
  return {mixed(0), mixed(1), mixed(2)};
}

}  // namespace

const strict_files::Choices<ViewColoring>& choicesOf(ViewColoring) {
  static const strict_files::Choices<ViewColoring> choices = {
      {"class", ViewColoring::Class},      {"probability", ViewColoring::Probability},
      {"entropy", ViewColoring::Entropy},  {"occupancy", ViewColoring::Occupancy},
      {"height", ViewColoring::Height},    {"gain", ViewColoring::Gain},
      {"retained", ViewColoring::Retained}};
  return choices;
}

namespace {
tree_abstraction::AbstractionWeights allClassesOf(const SemanticOcTree& map) {
  tree_abstraction::AbstractionWeights weights;
  weights.terms = {tree_abstraction::wholeClassVariable("all", 1, map.numClasses())};
  return weights;
}
}  // namespace

bool ViewStyle::hidesClasses() const {
  return std::find(hiddenClasses.begin(), hiddenClasses.end(), true) != hiddenClasses.end();
}

CellLook::CellLook(const SemanticOcTree& map)
    : m_map(map),
      m_question(allClassesOf(map), map.numClasses()),
      m_model(map.numClasses(), map.filterParameters()),
      m_filter(map.numClasses(), map.filterParameters()) {
  forget();
}

void CellLook::forget() {
  m_inner.clear();
  Eigen::Vector3d low, high;
  m_map.getMetricMin(low.x(), low.y(), low.z());
  m_map.getMetricMax(high.x(), high.y(), high.z());
  m_known = {low, high};
}

bool CellLook::isShown(const ViewCell& cell) const {
  const Eigen::Vector3d center = cell.center(m_map.getResolution());
  if (!m_style.clip.contains(center)) return false;
  if (!cell.node) return m_style.unknownSpace && m_known.contains(center);
  if (!cell.isOccupied()) return m_style.freeSpace;
  const ClassId id = m_style.hidesClasses() ? classOf(cell) : ClassId(0);
  return !m_style.hidesClasses() || id >= m_style.hiddenClasses.size() ||
         !m_style.hiddenClasses[id];
}

KeyBox CellLook::bounds() const {
  const Eigen::AlignedBox3d box = m_known.intersection(m_style.clip);
  // What is known ends at borders of voxels, up to rounding.
  constexpr double kRounding = 1e-6;
  const auto voxels = [this](const Eigen::Vector3d& place) {
    return (place.array() / m_map.getResolution() - 0.5 + semantic_octree::kKeyOfOrigin).eval();
  };
  return {(voxels(box.min()) - kRounding).ceil().cast<int>(),
          (voxels(box.max()) + kRounding).floor().cast<int>()};
}

std::pair<double, double> CellLook::heights() const {
  return {std::max(m_known.min().z(), m_style.clip.min().z()),
          std::min(m_known.max().z(), m_style.clip.max().z())};
}

std::optional<ColorScale> CellLook::scale() const {
  const auto meters = [](double z) { return strict_files::textOf(std::round(z * 10) / 10); };
  switch (m_style.coloring) {
    case ViewColoring::Probability:
      return ColorScale{"of the likeliest class", "0", "1"};
    case ViewColoring::Entropy:
      return ColorScale{"share of the highest", "1", "0"};
    case ViewColoring::Occupancy:
      return ColorScale{"p(occupied)", "0.5", "1"};
    case ViewColoring::Height:
      return ColorScale{"height, m", meters(heights().first), meters(heights().second), ramp};
    case ViewColoring::Gain:
      return ColorScale{"a look tells, of the first", "100 %", "0 %"};
    case ViewColoring::Retained:
      return ColorScale{"retained of its block", "0 %", "100 %"};
    case ViewColoring::Class:
      break;
  }
  return {};
}

Color CellLook::colorOf(const ViewCell& cell) const {
  if (!cell.node) return kUnknown;
  if (!cell.isOccupied()) return kFree;
  switch (m_style.coloring) {
    case ViewColoring::Probability:
      return trafficLight(stateOf(cell).probability);
    case ViewColoring::Entropy:
      return trafficLight(1 - relativeEntropy(m_map.distribution(cell.node)));
    case ViewColoring::Occupancy:
      return trafficLight(2 * cell.node.getOccupancy() - 1);
    case ViewColoring::Height:
      return ramp((cell.center(m_map.getResolution()).z() - heights().first) /
                  std::max(heights().second - heights().first, 1e-6));
    case ViewColoring::Gain:
      return trafficLight(1 - gainOf(cell.node));
    case ViewColoring::Retained:
      return trafficLight(m_compression ? m_compression->retainedAround(cell.around) : 1);
    case ViewColoring::Class:
      break;
  }
  return semantic_types::colorOf(classOf(cell), m_map.classes());
}

/** Filter and limits are of leaves. */
double CellLook::gainOf(const SemanticOcTreeNode& node) const {
  const double first = m_question.fallThrough(m_filter, m_model, m_filter.uniform(0));
  const double now = node.isLeaf()
                         ? m_question.fallThrough(m_filter, m_model, m_map.belief(node))
                         : m_question.information(m_model, m_map.distribution(node).data());
  return std::clamp(now / first, 0.0, 1.0);
}

CellLook::State CellLook::newState(const ViewCell& cell) const {
  const semantic_octree::CellState state = m_map.query(cell.node);
  return {state.likeliestClass, static_cast<float>(state.probability)};
}

/** Inner nodes take a look at all leaves below them. */
CellLook::State CellLook::stateOf(const ViewCell& cell) const {
  if (cell.innerNode == 0) return newState(cell);
  const auto known = m_inner.find(cell.innerNode);
  if (known != m_inner.end()) return known->second;
  return m_inner.emplace(cell.innerNode, newState(cell)).first->second;
}

}  // namespace map_view
