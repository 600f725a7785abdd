#include <semantic_octree/ColumnScan.h>

#include <semantic_octree/store/MapAccess.h>
#include <semantic_octree/store/NodeStore.h>

#include <algorithm>
#include <utility>

namespace semantic_octree {
namespace {

using Node = SemanticOcTree::Node;

/** Collects what columns hold, each column's from below. */
template <class T>
class Stacks {
 public:
  Stacks() {
    m_last.fill(-1);
    m_all.reserve(2 * kTileColumns);
  }

  /** \param grows whether what is below goes on in it, if it touches that */
  template <class F>
  void add(int column, const T& t, F grows) {
    int& last = m_last[column];
    if (last >= 0 && m_all[last].second.top + 1 == t.bottom && grows(m_all[last].second, t)) return;
    last = static_cast<int>(m_all.size());
    m_all.emplace_back(column, t);
  }

  ByColumn<T> byColumn() const {
    ByColumn<T> sorted;
    for (const auto& [column, t] : m_all) ++sorted.first[column + 1];
    for (int column = 0; column < kTileColumns; ++column)
      sorted.first[column + 1] =
          static_cast<std::uint16_t>(sorted.first[column + 1] + sorted.first[column]);
    sorted.all.resize(m_all.size());
    auto next = sorted.first;
    for (const auto& [column, t] : m_all) sorted.all[next[column]++] = t;
    return sorted;
  }

 private:
  std::vector<std::pair<int, T>> m_all;
  std::array<int, kTileColumns> m_last;  ///< each column's in m_all
};

class TileScan {
 public:
  TileScan(const SemanticOcTree& map, Column tile, float sure)
      : m_map(map), m_low(firstColumnOf(tile)), m_sure(sure) {}

  ColumnTile scan() {
    if (m_map.root()) visit(m_map.root(), {0, 0}, 0, 1 << m_map.getTreeDepth());
    return {m_runs.byColumn(), m_spaces.byColumn()};
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
    if (NodeStore::slotOf(node).kind == Slot::Kind::Block) return addBlock(node, low, z);
    const int half = size / 2;
    for (int i = 0; i < 8; ++i)
      if (const Node child = node.child(i))
        visit(child, {low.x + (i & 1 ? half : 0), low.y + (i & 2 ? half : 0)},
              z + (i & 4 ? half : 0), half);
  }

  /** Voxel by voxel, without a node for each. */
  void addBlock(const Node& node, Column low, int z) {
    const Block& block = MapAccess::store(m_map).block(NodeStore::slotOf(node));
    for (int i = 0, corner = indexInTile(low); i < 64; ++i) {
      if (!(block.known >> i & 1)) continue;
      const int row = (i >> 1 & 1) + (i >> 3 & 2), column = corner + (i & 1) + (i >> 2 & 2);
      const auto key = static_cast<std::uint16_t>(z + (i >> 2 & 1) + (i >> 4 & 2));
      const float logOdds = fromUnits(block.values[i]);
      if (logOdds > 0)
        addRun(column + row * kTileEdge, {key, key, classOf(leafAt(node, i))});
      else
        addSpace(column + row * kTileEdge, {key, key, logOdds <= m_sure});
    }
  }

  static Node leafAt(const Node& block, int voxel) {
    const Node octant = block.child(voxel / 8);
    return octant.isLeaf() ? octant : octant.child(voxel % 8);
  }

  void addLeaf(const Node& node, Column low, int z, int size) {
    const float logOdds = node.getLogOdds();
    const auto bottom = static_cast<std::uint16_t>(z);
    const auto top = static_cast<std::uint16_t>(z + size - 1);
    if (logOdds > 0) {
      const Run run{bottom, top, classOf(node)};
      forColumns(low, size, [&](int column) { addRun(column, run); });
    } else {
      const Space space{bottom, top, logOdds <= m_sure};
      forColumns(low, size, [&](int column) { addSpace(column, space); });
    }
  }

  /** f(index) for the columns of a node that are in the tile. */
  template <class F>
  void forColumns(Column low, int size, F f) const {
    const int xEnd = std::min(low.x + size, m_low.x + kTileEdge);
    const int yEnd = std::min(low.y + size, m_low.y + kTileEdge);
    for (int y = std::max(low.y, m_low.y); y < yEnd; ++y)
      for (int x = std::max(low.x, m_low.x); x < xEnd; ++x) f(indexInTile({x, y}));
  }

  void addRun(int column, const Run& run) {
    m_runs.add(column, run, [](Run& below, const Run& above) {
      below.top = above.top;
      below.topClass = above.topClass;
      return true;
    });
  }

  void addSpace(int column, const Space& space) {
    m_spaces.add(column, space, [](Space& below, const Space& above) {
      if (below.isSure != above.isSure) return false;
      below.top = above.top;
      return true;
    });
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
  const float m_sure;
  Stacks<Run> m_runs;
  Stacks<Space> m_spaces;
};

/** At most the log-odds of a free voxel that two scans' beams passed: halfway between one and two,
 * but no less than any number leads to. */
float sureOf(const SemanticOcTree& map) {
  const ClassFilter filter(map.numClasses(), map.filterParameters());
  return std::max(1.5f * filter.missIncrement(), filter.lowestOccupancy());
}

}  // namespace

bool ColumnTile::isKnown(int column, int z) const {
  const auto holds = [z](const auto& part) { return part.bottom <= z && part.top >= z; };
  return std::any_of(runs.begin(column), runs.end(column), holds) ||
         std::any_of(spaces.begin(column), spaces.end(column), holds);
}

/** Whether free space goes from one height to another, at the lower one of which it is sure. */
bool ColumnTile::isSureFrom(int column, int low, int high) const {
  const Space* const end = spaces.end(column);
  const Space* s = std::find_if(spaces.begin(column), end,
                                [low](const Space& space) { return space.top >= low; });
  if (s == end || s->bottom > low || !s->isSure) return false;
  while (s->top < high) {
    const Space* above = s + 1;
    if (above == end || above->bottom != s->top + 1) return false;
    s = above;
  }
  return true;
}

bool ColumnTile::isOverDrop(int column, int low, int high, int step, int near) const {
  const int deep = low - step;
  if (isSureFrom(column, deep, high)) return isKnown(column, deep - 1);
  const Space *begin = spaces.begin(column), *end = spaces.end(column);
  if (std::any_of(begin, end, [](const Space& s) { return s.isSure; })) return false;
  return std::any_of(begin, end, [&](const Space& s) {
    return s.bottom < deep && s.top >= s.bottom + 2 && s.top >= deep - near;
  });
}

bool ColumnTile::isGhost(int column, int low, int high) const {
  int seen = 0;
  bool isSureAbove = false;
  for (const Space* s = spaces.begin(column); s != spaces.end(column); ++s) {
    isSureAbove = isSureAbove || (s->isSure && s->top > high);
    const int bottom = std::max(low + 1, int(s->bottom)), top = std::min(high - 1, int(s->top));
    if (bottom > top) continue;
    if (s->isSure) return false;
    seen += top - bottom + 1;
  }
  return isSureAbove && 2 * seen < high - low - 1;
}

int ColumnTile::floorOf(int column, int margin) const {
  for (const Run* run = runs.begin(column); run != runs.end(column); ++run) {
    const Run* next = run + 1;
    if (next != runs.end(column)) {
      if (!isGhost(column, run->top, next->bottom)) return run->bottom;
      continue;
    }
    const Space* sure =
        std::find_if(spaces.begin(column), spaces.end(column),
                     [run](const Space& s) { return s.isSure && s.bottom > run->top; });
    const bool isFar = sure != spaces.end(column) && sure->bottom > run->top + 1 + margin;
    if (!isFar || !isGhost(column, run->top, sure->bottom - 1)) return run->bottom;
  }
  return kNumKeys;
}

ColumnScanner::ColumnScanner(const SemanticOcTree& map) : m_map(map), m_sure(sureOf(map)) {}

ColumnTile ColumnScanner::scan(Column tile) const { return TileScan(m_map, tile, m_sure).scan(); }

}  // namespace semantic_octree
