#include "ColumnScan.h"

namespace semantic_planning {
namespace {

using semantic_octree::SemanticOcTree;
using Node = SemanticOcTree::Node;

struct OpenRun {
  int column, bottom, top;
  ClassId topClass;
};

class TileScan {
 public:
  TileScan(const SemanticOcTree& map, Column tile) : m_map(map), m_low(firstColumnOf(tile)) {
    m_last.fill(-1);
  }

  ColumnTile scan() {
    if (m_map.root()) visit(m_map.root(), {0, 0}, 0, 1 << m_map.getTreeDepth());
    sortRuns();
    return std::move(m_tile);
  }

 private:
  bool overlaps(Column low, int size) const {
    return low.x < m_low.x + kTileEdge && low.x + size > m_low.x && low.y < m_low.y + kTileEdge &&
           low.y + size > m_low.y;
  }

  /** A node: its lowest keys and its edge. Lower children come first, so that each column sees its
   * voxels from below. */
  void visit(const Node& node, Column low, int z, int size) {
    if (!overlaps(low, size)) return;
    if (node.isLeaf()) return addLeaf(node, low, z, size);
    const int half = size / 2;
    for (int i = 0; i < 8; ++i)
      if (const Node child = node.child(i))
        visit(child, {low.x + (i & 1 ? half : 0), low.y + (i & 2 ? half : 0)},
              z + (i & 4 ? half : 0), half);
  }

  void addLeaf(const Node& node, Column low, int z, int size) {
    const bool occupied = node.getLogOdds() > 0;
    const ClassId classId = occupied ? classOf(node) : semantic_types::kNoClass;
    const int xEnd = std::min(low.x + size, m_low.x + kTileEdge);
    const int yEnd = std::min(low.y + size, m_low.y + kTileEdge);
    for (int y = std::max(low.y, m_low.y); y < yEnd; ++y)
      for (int x = std::max(low.x, m_low.x); x < xEnd; ++x) {
        const int column = indexInTile({x, y});
        if (occupied)
          addRun({column, z, z + size - 1, classId});
        else
          m_tile.lowestFree[column] =
              static_cast<std::uint16_t>(std::min<int>(m_tile.lowestFree[column], z));
      }
  }

  void addRun(const OpenRun& run) {
    int& last = m_last[run.column];
    if (last >= 0 && m_runs[last].top + 1 == run.bottom) {
      m_runs[last].top = run.top;
      m_runs[last].topClass = run.topClass;
    } else {
      last = static_cast<int>(m_runs.size());
      m_runs.push_back(run);
    }
  }

  /** By column; within one they come from below. */
  void sortRuns() {
    for (const OpenRun& run : m_runs) ++m_tile.first[run.column + 1];
    for (int column = 0; column < kTileColumns; ++column)
      m_tile.first[column + 1] =
          static_cast<std::uint16_t>(m_tile.first[column + 1] + m_tile.first[column]);
    m_tile.runs.resize(m_runs.size());
    auto next = m_tile.first;
    for (const OpenRun& run : m_runs)
      m_tile.runs[next[run.column]++] = {static_cast<std::uint16_t>(run.bottom),
                                         static_cast<std::uint16_t>(run.top), run.topClass};
  }

  /** SemanticOcTree::query()'s, without probabilities where one class is ahead of all. */
  ClassId classOf(const Node& leaf) const {
    if (!leaf.hasClassRecord()) return semantic_types::kNoClass;
    const SemanticOcTree::Belief belief = m_map.belief(leaf);
    const bool isAhead = belief.count > 0 && belief.logOdds[0] > belief.rest;
    return isAhead ? belief.ids[0] : m_map.query(leaf).likeliestClass;
  }

  const SemanticOcTree& m_map;
  const Column m_low;
  ColumnTile m_tile;
  std::vector<OpenRun> m_runs;
  std::array<int, kTileColumns> m_last;  ///< each column's run in m_runs
};

}  // namespace

ColumnTile scanColumns(const SemanticOcTree& map, Column tile) {
  return TileScan(map, tile).scan();
}

}  // namespace semantic_planning
