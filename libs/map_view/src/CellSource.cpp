#include <map_view/CellSource.h>

#include <unordered_map>

namespace map_view {

using semantic_octree::edgeAtDepth;
using semantic_octree::kTreeDepth;
using semantic_octree::LeafCell;
using semantic_octree::lowestKeyAtDepth;

namespace {

ViewCell childOf(const ViewCell& cell, int i) {
  const int half = cell.edge() / 2;
  return {cell.lowest + half * Eigen::Array3i(i & 1, i >> 1 & 1, i >> 2 & 1), cell.depth + 1,
          cell.node.child(i), 0};
}

/** Walks over the map's leaves. */
class FullWalk {
 public:
  FullWalk(const KeyBox& box, int maxDepth, const CellLook& look, const CellSource::Visit& visit)
      : m_box(box), m_maxDepth(maxDepth), m_look(look), m_visit(visit) {}

  void walk(const ViewCell& cell) const {
    if (!cell.node || !m_box.meets(cell.lowest, cell.edge())) return;
    if (!cell.isOccupied() && !m_look.style().freeSpace) return;  // nor is what is below it
    if (cell.node.isLeaf()) {
      if (m_look.isShown(cell)) m_visit(cell);
    } else if (cell.depth == m_maxDepth) {
      ViewCell shown = cell;
      shown.node = shownBelow(cell, true);
      if (!shown.node && m_look.style().freeSpace) shown.node = shownBelow(cell, false);
      if (shown.node) m_visit(shown);
    } else {
      for (int i = 0; i < 8; ++i) walk(childOf(cell, i));
    }
  }

 private:
  /** A leaf below a node that is shown: from its upper half, if there is one. */
  semantic_octree::SemanticOcTreeNode shownBelow(const ViewCell& cell, bool occupied) const {
    if (!cell.node || (occupied && !cell.isOccupied())) return {};
    if (cell.node.isLeaf())
      return cell.isOccupied() == occupied && m_look.isShown(cell)
                 ? cell.node
                 : semantic_octree::SemanticOcTreeNode();
    for (int i = 7; i >= 0; --i)
      if (const auto node = shownBelow(childOf(cell, i), occupied)) return node;
    return {};
  }

  const KeyBox& m_box;
  int m_maxDepth;
  const CellLook& m_look;
  const CellSource::Visit& m_visit;
};

ViewCell rootOf(const SemanticOcTree& map) {
  return {Eigen::Array3i::Zero(), 0,
          map.empty() ? semantic_octree::SemanticOcTreeNode() : map.root(), 0};
}

/** Three keys and a depth in one number. */
std::uint64_t packed(const Eigen::Array3i& lowest, int depth) {
  return std::uint64_t(lowest.x()) | std::uint64_t(lowest.y()) << 16 |
         std::uint64_t(lowest.z()) << 32 | std::uint64_t(depth) << 48;
}

ViewCell viewCell(const LeafCell& leaf) {
  const int depth = static_cast<int>(leaf.depth);
  return {leaf.lowest(), depth, leaf.node,
          leaf.node.isLeaf() ? 0 : packed(leaf.lowest(), depth + 1)};
}

octomap::OcTreeKey clamped(const Eigen::Array3i& key) {
  const Eigen::Array3i k = key.max(0).min(semantic_octree::kNumKeys - 1);
  return semantic_octree::octomapKey(k.x(), k.y(), k.z());
}

/** Finer cells than a depth, drawn together: occupied ones before free ones, higher before lower.
 */
class Together {
 public:
  explicit Together(int depth) : m_depth(depth) {}

  void add(const ViewCell& cell) {
    const Eigen::Array3i lowest =
        cell.lowest.unaryExpr([this](int key) { return lowestKeyAtDepth(key, m_depth); });
    const auto [at, isNew] = m_index.emplace(packed(lowest, m_depth), m_cells.size());
    if (isNew) m_cells.push_back({{lowest, m_depth, cell.node, cell.innerNode}, cell.lowest.z()});
    Entry& entry = m_cells[at->second];
    const auto rank = [](bool occupied, int height) { return std::make_pair(occupied, height); };
    if (rank(cell.isOccupied(), cell.lowest.z()) <= rank(entry.cell.isOccupied(), entry.height))
      return;
    entry = {{lowest, m_depth, cell.node, cell.innerNode}, cell.lowest.z()};
  }
  void forEach(const CellSource::Visit& visit) const {
    for (const Entry& entry : m_cells) visit(entry.cell);
  }

 private:
  struct Entry {
    ViewCell cell;
    int height;  ///< key of the cell that is shown
  };
  int m_depth;
  std::vector<Entry> m_cells;
  std::unordered_map<std::uint64_t, std::size_t> m_index;
};

}  // namespace

void FullCells::forEachShown(const KeyBox& box, int maxDepth, const CellLook& look,
                             const Visit& visit) const {
  FullWalk(box, maxDepth, look, visit).walk(rootOf(m_map));
}

ViewCell FullCells::at(const Eigen::Array3i& key) const {
  ViewCell cell = rootOf(m_map);
  while (cell.node && !cell.node.isLeaf()) {
    const int bit = kTreeDepth - 1 - cell.depth;
    cell = childOf(cell, (key[0] >> bit & 1) | (key[1] >> bit & 1) << 1 | (key[2] >> bit & 1) << 2);
  }
  return cell;
}

void CompressedCells::forEachShown(const KeyBox& box, int maxDepth, const CellLook& look,
                                   const Visit& visit) const {
  Together together(maxDepth);
  for (const LeafCell& leaf :
       m_abstraction.leavesIn(clamped(box.low), clamped(box.high), !look.style().freeSpace)) {
    const ViewCell cell = viewCell(leaf);
    if (!look.isShown(cell)) continue;
    if (cell.depth > maxDepth)
      together.add(cell);
    else
      visit(cell);
  }
  together.forEach(visit);
}

ViewCell CompressedCells::at(const Eigen::Array3i& key) const {
  const auto leaves = m_abstraction.leavesIn(clamped(key), clamped(key), false);
  return leaves.empty() ? FullCells(m_map).at(key) : viewCell(leaves.front());
}

}  // namespace map_view
