#include <map_view/CellSource.h>
#include <semantic_abstraction/AbstractionOptions.h>

#include <algorithm>
#include <array>
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

/** So are inner nodes that the compressed tree does not expand. */
struct CompressedNode : MapNode {
  const LiveCompression* compression;
  InformationTree::Index index = 0;  ///< of an inner node of the map

  CompressedNode(const SemanticOcTree& map, const LiveCompression& live)
      : MapNode(map), compression(&live) {
    mark();
  }

  bool isLeaf() const { return cell.node.isLeaf() || !compression->isExpanded(index); }
  template <class F>
  void forEachChild(const F& f) const {
    InformationTree::Index next = index + 1;
    for (int i = 0; i < 8; ++i) {
      const CompressedNode child(*this, i, next);
      if (!child.cell.node) continue;
      if (!child.cell.node.isLeaf()) next = compression->tree().end(next);
      f(child);
    }
  }

 private:
  CompressedNode(const CompressedNode& parent, int i, InformationTree::Index at)
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

  /** As large cubes as there are within the bounds. */
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

void FullCells::forEachShown(const KeyBox& box, int maxDepth, const CellLook& look,
                             const Visit& visit) const {
  if (!m_map.empty()) Walk<MapNode>(box, maxDepth, look, visit).walk(MapNode(m_map));
}

ViewCell FullCells::at(const Eigen::Array3i& key) const { return leafAt(key, MapNode(m_map)); }

void CompressedCells::forEachShown(const KeyBox& box, int maxDepth, const CellLook& look,
                                   const Visit& visit) const {
  Walk<CompressedNode>(box, maxDepth, look, visit).walk(CompressedNode(m_map, m_compression));
}

ViewCell CompressedCells::at(const Eigen::Array3i& key) const {
  return leafAt(key, CompressedNode(m_map, m_compression));
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

}  // namespace map_view
