#include "ColumnScan.h"

namespace semantic_planning {
namespace {

using semantic_octree::SemanticOcTree;
using Node = SemanticOcTree::Node;

struct OpenRun {
  int bottom, top;
  const Node* topNode;
};

class TileScan {
 public:
  TileScan(const SemanticOcTree& map, Column tile) : m_map(map), m_low(firstColumnOf(tile)) {
    m_lowestFree.fill(kNeverFree);
  }

  ColumnTile scan() {
    if (m_map.root()) visit(*m_map.root(), {0, 0}, 0, 1 << m_map.getTreeDepth());
    return flatten();
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
    for (unsigned i = 0; i < 8; ++i)
      if (m_map.nodeChildExists(&node, i))
        visit(*m_map.getNodeChild(&node, i),
              {low.x + (i & 1 ? half : 0), low.y + (i & 2 ? half : 0)}, z + (i & 4 ? half : 0),
              half);
  }

  void addLeaf(const Node& node, Column low, int z, int size) {
    const bool occupied = node.getLogOdds() > 0;
    const int xEnd = std::min(low.x + size, m_low.x + kTileEdge);
    const int yEnd = std::min(low.y + size, m_low.y + kTileEdge);
    for (int y = std::max(low.y, m_low.y); y < yEnd; ++y)
      for (int x = std::max(low.x, m_low.x); x < xEnd; ++x) {
        const int column = indexInTile({x, y});
        if (occupied)
          addRun(m_runs[column], {z, z + size - 1, &node});
        else
          m_lowestFree[column] = static_cast<std::uint16_t>(std::min<int>(m_lowestFree[column], z));
      }
  }

  static void addRun(std::vector<OpenRun>& runs, const OpenRun& run) {
    if (!runs.empty() && runs.back().top + 1 == run.bottom) {
      runs.back().top = run.top;
      runs.back().topNode = run.topNode;
    } else {
      runs.push_back(run);
    }
  }

  ColumnTile flatten() const {
    ColumnTile tile;
    tile.lowestFree = m_lowestFree;
    for (int column = 0; column < kTileColumns; ++column) {
      for (const OpenRun& run : m_runs[column])
        tile.runs.push_back({static_cast<std::uint16_t>(run.bottom),
                             static_cast<std::uint16_t>(run.top),
                             m_map.query(*run.topNode).likeliestClass});
      tile.first[column + 1] = static_cast<std::uint16_t>(tile.runs.size());
    }
    return tile;
  }

  const SemanticOcTree& m_map;
  const Column m_low;
  std::array<std::vector<OpenRun>, kTileColumns> m_runs;
  std::array<std::uint16_t, kTileColumns> m_lowestFree;
};

}  // namespace

ColumnTile scanColumns(const SemanticOcTree& map, Column tile) {
  return TileScan(map, tile).scan();
}

}  // namespace semantic_planning
