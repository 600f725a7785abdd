#include "SurfaceMarks.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>

namespace semantic_planning {
namespace {

/** Half of a column's neighbors; the others look from their side. */
constexpr std::array<Column, 4> kForward = {{{1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

std::size_t rootOf(std::vector<std::size_t>& parent, std::size_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

void join(std::vector<std::size_t>& parent, std::size_t a, std::size_t b) {
  a = rootOf(parent, a);
  b = rootOf(parent, b);
  parent[std::max(a, b)] = std::min(a, b);
}

std::size_t numComponents(const SurfaceTile& tile) {
  std::size_t components = 0;
  for (const Surface& s : tile.surfaces)
    components = std::max<std::size_t>(components, s.component + 1);
  return components;
}

/** The drivable surface of a tile's column to which the wheels get from height z; or none. */
int climbableIndex(const SurfaceTile& tile, int column, int z, int step) {
  for (int i = tile.first[column]; i < tile.first[column + 1]; ++i)
    if (tile.surfaces[i].drivable && std::abs(int(tile.surfaces[i].z) - z) <= step) return i;
  return -1;
}

/** From 0 on, in the order of their first surfaces. \return the columns whose numbers changed. */
ColumnBox numberComponents(Column tile, std::vector<std::size_t>& parent, SurfaceTile& marked) {
  ColumnBox changed;
  std::uint16_t components = 0;
  std::vector<std::uint16_t> number(parent.size());
  forSurfacesOf(tile, marked, [&](Column c, std::size_t i) {
    const std::size_t root = rootOf(parent, i);
    number[i] = root == i ? components++ : number[root];
    if (marked.surfaces[i].component != number[i]) changed.add(c);
    marked.surfaces[i].component = number[i];
  });
  return changed;
}

}  // namespace

ColumnBox markComponents(Column tile, SurfaceTile& marked, const GroundShape& shape) {
  std::vector<std::size_t> parent(marked.surfaces.size());
  std::iota(parent.begin(), parent.end(), 0);
  forSurfacesOf(tile, marked, [&](Column c, std::size_t i) {
    if (!marked.surfaces[i].drivable) return;
    for (const Column& d : kForward) {
      const Column next{c.x + d.x, c.y + d.y};
      if (!(tileOf(next) == tile)) continue;
      const int j = climbableIndex(marked, indexInTile(next), marked.surfaces[i].z, shape.step);
      if (j >= 0) join(parent, i, j);
    }
  });
  return numberComponents(tile, parent, marked);
}

GroundComponents::GroundComponents(const SurfaceGrid& surfaces, const GroundShape& shape) {
  std::size_t components = 0;
  surfaces.forEach([&](Column tile, const SurfaceTile& t) {
    m_firstOfTile.at(tile) = components;
    components += numComponents(t);
  });
  m_parent.resize(components);
  std::iota(m_parent.begin(), m_parent.end(), 0);
  surfaces.forEach([&](Column tile, const SurfaceTile& t) {
    if (!t.surfaces.empty()) joinAcrossBorders(surfaces, tile, shape);
  });
  for (std::size_t i = 0; i < m_parent.size(); ++i) m_parent[i] = rootOf(m_parent, i);
}

void GroundComponents::joinAcrossBorders(const SurfaceGrid& surfaces, Column tile,
                                         const GroundShape& shape) {
  forColumnsOf(tile, [&](Column c) {
    const Column inTile{c.x & 15, c.y & 15};
    if (inTile.x > 0 && inTile.x < kTileEdge - 1 && inTile.y < kTileEdge - 1) return;
    for (const Surface& s : surfacesAt(surfaces, c))
      for (const Column& d : kForward) {
        const Column next{c.x + d.x, c.y + d.y};
        const Surface* other = s.drivable ? surfaceNear(surfaces, next, s.z, shape.step) : nullptr;
        if (other && other->drivable)
          join(m_parent, *m_firstOfTile.find(tile) + s.component,
               *m_firstOfTile.find(tileOf(next)) + other->component);
      }
  });
}

std::size_t GroundComponents::componentOf(Column c, const Surface& s) const {
  return m_parent[*m_firstOfTile.find(tileOf(c)) + s.component];
}

ObstacleTile obstaclesIn(const SurfaceGrid& surfaces, Column tile, const GroundShape& shape) {
  const SurfaceWindow window(surfaces, tile, 1);
  const auto isFree = [&](const Surface& s) { return s.drivable && !shape.keepOff[s.classId]; };
  ObstacleTile found;
  std::vector<std::uint16_t>& heights = found.all;
  forColumnsOf(tile, [&](Column c) {
    const auto begin = static_cast<std::ptrdiff_t>(heights.size());
    const SurfaceRange own = surfacesAt(window, c);
    for (const Surface& s : own)
      if (!isFree(s)) heights.push_back(s.z);
    for (int y = c.y - 1; y <= c.y + 1; ++y)
      for (int x = c.x - 1; x <= c.x + 1; ++x)
        for (const Surface& s : surfacesAt(window, {x, y}))
          if (!surfaceNear(own, s.z, shape.step) && isFree(s)) heights.push_back(s.z);
    std::sort(heights.begin() + begin, heights.end());
    heights.erase(std::unique(heights.begin() + begin, heights.end()), heights.end());
    found.first[indexInTile(c) + 1] = static_cast<std::uint16_t>(heights.size());
  });
  heights.shrink_to_fit();
  return found;
}

namespace {

/** Columns between two columns along an axis. */
int between(int a, int b) { return std::max(0, std::abs(a - b) - 1); }

/** How far ground may have gone up or down on the way: what differs by more is another level. */
int levelTolerance(int columns, const GroundShape& shape) {
  return std::min(shape.height, 2 * shape.step + 1 + static_cast<int>(shape.rise * columns));
}

}  // namespace

/** Obstacles around a tile. Most columns have none, which is known at once. */
class ClearanceMeter::Around {
 public:
  Around(const ObstacleGrid& obstacles, Column tile, int reach)
      : m_tiles(obstacles, tile, reach), m_edge(kTileEdge + 2 * reach) {
    const Column first = firstColumnOf(tile);
    m_low = {first.x - reach, first.y - reach};
    for (int y = m_low.y; y < m_low.y + m_edge; ++y)
      for (int x = m_low.x; x < m_low.x + m_edge; ++x)
        m_any.push_back(beginAt({x, y}) != endAt({x, y}));
  }

  /** Whether a column has any; the next row's is an edge farther on. */
  const char* any(Column c) const {
    return m_any.data() + (c.y - m_low.y) * m_edge + c.x - m_low.x;
  }

  /** That of a column at about height z; or null. */
  const std::uint16_t* at(Column c, int z, int tolerance) const {
    const auto* found = std::find_if(beginAt(c), endAt(c),
                                     [&](int height) { return std::abs(height - z) <= tolerance; });
    return found == endAt(c) ? nullptr : found;
  }

 private:
  const std::uint16_t* beginAt(Column c) const { return m_tiles.around(c).begin(indexInTile(c)); }
  const std::uint16_t* endAt(Column c) const { return m_tiles.around(c).end(indexInTile(c)); }

  const TileWindow<ObstacleTile> m_tiles;
  Column m_low;
  int m_edge;
  std::vector<char> m_any;
};

ClearanceMeter::ClearanceMeter(const GroundShape& shape) : m_farthest(shape.largestClearance) {
  const int farthest2 = m_farthest * m_farthest;
  for (int y = -m_farthest; y <= m_farthest; ++y)
    for (int x = -m_farthest; x <= m_farthest; ++x) {
      const int dx = between(x, 0), dy = between(y, 0);
      if (dx * dx + dy * dy < farthest2)
        m_places.push_back({x, y, dx * dx + dy * dy, levelTolerance(std::max(dx, dy) + 1, shape),
                            y * (kTileEdge + 2 * m_farthest) + x});
    }
  std::stable_sort(m_places.begin(), m_places.end(),
                   [](const Place& l, const Place& r) { return l.clearance2 < r.clearance2; });
}

std::optional<ClearanceMeter::Obstacle> ClearanceMeter::nearest(const Around& around, Column c,
                                                                int z) const {
  const char* const any = around.any(c);
  for (const Place& p : m_places) {
    if (!any[p.offset]) continue;
    const Column at{c.x + p.x, c.y + p.y};
    if (const auto* height = around.at(at, z, p.tolerance))
      return Obstacle{at, *height, p.clearance2};
  }
  return std::nullopt;
}

std::optional<ClearanceMeter::Obstacle> ClearanceMeter::nearest(const ObstacleGrid& obstacles,
                                                                Column c, int z) const {
  return nearest(Around(obstacles, tileOf(c), m_farthest), c, z);
}

ColumnBox ClearanceMeter::measure(const ObstacleGrid& obstacles, Column tile,
                                  SurfaceTile& measured) const {
  ColumnBox changed;
  if (measured.surfaces.empty()) return changed;
  const Around around(obstacles, tile, m_farthest);
  forSurfacesOf(tile, measured, [&](Column c, std::size_t i) {
    Surface& s = measured.surfaces[i];
    const auto obstacle = nearest(around, c, s.z);
    const int clearance2 = obstacle ? obstacle->clearance2 : m_farthest * m_farthest;
    if (s.clearance2 != clearance2) changed.add(c);
    s.clearance2 = static_cast<std::uint16_t>(clearance2);
  });
  return changed;
}

}  // namespace semantic_planning
