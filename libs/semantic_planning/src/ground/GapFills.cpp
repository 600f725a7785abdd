#include "GapFills.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace semantic_planning {
namespace {

class GapFillSearch {
 public:
  GapFillSearch(const ScanGrid& columns, const SurfaceGrid& measured, Column tile,
                const GroundShape& shape)
      : m_columns(columns, tile, reachOfGapFills(shape)),
        m_measured(measured, tile, reachOfGapFills(shape)),
        m_shape(shape) {}

  std::vector<GapFill> from(Column tile) {
    forColumnsOf(tile, [&](Column c) {
      const SurfaceRange column = surfacesAt(m_measured, c);
      if (column.empty()) return;
      for (int d = 0; d < int(kDirections.size()); ++d)
        for (const Surface& s : column) lookAcross(c, s, d);
    });
    return std::move(m_found);
  }

 private:
  /** From a surface whose neighbor is missing to the next surface on the line. */
  void lookAcross(Column from, const Surface& s, int direction) {
    const double length = kDirections[direction].length;
    GapFill fill;
    fill.from = from;
    fill.direction = direction;
    fill.z = s.z;
    fill.classId = s.classId;
    if (surfaceNear(m_measured, fill.column(1), s.z, m_shape.step)) return;
    while (!isInTheWay(fill) && fill.columns * length <= m_shape.widestGap) {
      const int n = ++fill.columns;
      const int tolerance = m_shape.step + static_cast<int>(n * length * m_shape.rise);
      const Surface* other = surfaceNear(m_measured, fill.column(n), s.z, tolerance);
      if (!other) continue;
      fill.otherZ = other->z;
      fill.otherClass = other->classId;
      if (isOverHole(fill)) m_found.push_back(fill);
      return;
    }
  }

  /** Whether a fill cannot go on over the column that it has come to, however high its other end
   * may be. */
  bool isInTheWay(const GapFill& begun) const {
    const int n = begun.columns;
    const double rise = kDirections[begun.direction].length * m_shape.rise;
    const int change = static_cast<int>(std::ceil(n * rise + m_shape.step + 0.5));
    return isInTheWay(begun.column(n), begun.z - change, begun.z + change);
  }

  bool isOverHole(const GapFill& fill) const {
    for (int i = 1; i < fill.columns; ++i)
      if (isInTheWay(fill.column(i), fill.height(i), fill.height(i))) return false;
    return true;
  }

  /** Whether, for every height from `low` to `high`, the column has something that stands in the
   * way, or a drop. */
  bool isInTheWay(Column c, int low, int high) const {
    const ColumnTile& tile = m_columns.around(c);
    const int column = indexInTile(c), step = m_shape.step;
    if (tile.isOverDrop(column, low, high, step, m_shape.height)) return true;
    return std::any_of(tile.runs.begin(column), tile.runs.end(column), [&](const Run& run) {
      return run.bottom <= low + m_shape.height && run.top >= high - step;
    });
  }

  const TileWindow<ColumnTile> m_columns;
  const SurfaceWindow m_measured;
  const GroundShape& m_shape;
  std::vector<GapFill> m_found;
};

/** Classes of what is around a surface, within a step in height. */
struct Votes {
  std::array<ClassId, (2 * kReachOfClasses + 1) * (2 * kReachOfClasses + 1)> allowed;
  int numAllowed = 0, numForbidden = 0;

  Votes(const TileWindow<ColumnTile>& columns, Column c, int z, int reach,
        const GroundShape& shape) {
    for (int y = c.y - reach; y <= c.y + reach; ++y)
      for (int x = c.x - reach; x <= c.x + reach; ++x) {
        const auto& runs = columns.around({x, y}).runs;
        const int column = indexInTile({x, y});
        const Run* run = std::find_if(runs.begin(column), runs.end(column), [&](const Run& r) {
          return std::abs(r.top - z) <= shape.step;
        });
        if (run == runs.end(column)) continue;
        if (shape.ranks[run->topClass] == colored_graph::kForbidden)
          ++numForbidden;
        else
          allowed[static_cast<std::size_t>(numAllowed++)] = run->topClass;
      }
  }
  ClassId mostFrequent() const {
    const auto end = allowed.begin() + numAllowed;
    return *std::max_element(allowed.begin(), end, [&](ClassId a, ClassId b) {
      return std::count(allowed.begin(), end, a) < std::count(allowed.begin(), end, b);
    });
  }
};

/** The class of a surface that is of a forbidden one: its own, unless most of what is around it is
 * of others. Where few columns next to it have any, those beyond count, too. */
ClassId classAmong(const TileWindow<ColumnTile>& columns, Column c, const Surface& s,
                   const GroundShape& shape) {
  constexpr int kFew = 5;  // most of nine
  for (int reach = 1; reach <= kReachOfClasses; ++reach) {
    const Votes votes(columns, c, s.z, reach, shape);
    if (votes.numAllowed > votes.numForbidden) return votes.mostFrequent();
    if (votes.numAllowed + votes.numForbidden >= kFew) break;
  }
  return s.classId;
}

}  // namespace

int GapFill::height(int i) const {
  return z + static_cast<int>(std::lround(double(int(otherZ) - z) * i / columns));
}

SurfaceTile measuredSurfaces(const ScanGrid& columns, Column tile, const GroundShape& shape) {
  const TileWindow<ColumnTile> window(columns, tile, kReachOfClasses);
  SurfaceTile measured;
  forColumnsOf(tile, [&](Column c) {
    const int column = indexInTile(c);
    const auto& runs = window.around(c).runs;
    for (const Run* run = runs.begin(column); run != runs.end(column); ++run) {
      const Run* above = run + 1;
      if (above != runs.end(column) && above->bottom <= run->top + shape.height) continue;
      Surface s;
      s.z = run->top;
      s.classId = run->topClass;
      if (shape.ranks[s.classId] == colored_graph::kForbidden)
        s.classId = classAmong(window, c, s, shape);
      measured.surfaces.push_back(s);
    }
    measured.first[column + 1] = static_cast<std::uint16_t>(measured.surfaces.size());
  });
  measured.surfaces.shrink_to_fit();
  return measured;
}

std::vector<GapFill> gapFillsFrom(const ScanGrid& columns, const SurfaceGrid& measured, Column tile,
                                  const GroundShape& shape) {
  return GapFillSearch(columns, measured, tile, shape).from(tile);
}

}  // namespace semantic_planning
