#include "GapFills.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "ColumnGrid.h"

namespace semantic_planning {
namespace {

class GapFillSearch {
 public:
  GapFillSearch(const ScanGrid& columns, const SurfaceGrid& measured, Column tile,
                const GroundShape& shape)
      : m_columns(columns, tile, reachOfGapFills(shape)),
        m_measured(measured, tile, reachOfGapFills(shape)),
        m_shape(shape) {}

  GapFillTile from(Column tile) {
    forColumnsOf(tile, [&](Column c) {
      const SurfaceRange column = surfacesAt(m_measured, c);
      if (column.empty()) return;
      for (int d = 0; d < int(kDirections.size()); ++d)
        for (const Surface& s : column) lookAcross(c, s, d);
    });
    m_found.fills.shrink_to_fit();
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
      if (isOverHole(fill)) add(fill);
      return;
    }
  }

  void add(const GapFill& fill) {
    m_found.fills.push_back(fill);
    m_found.box.add(fill.column(1)), m_found.box.add(fill.column(fill.columns - 1));
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
  GapFillTile m_found;
};

/** Classes of what is around a surface, within a step in height. */
struct Votes {
  std::array<ClassId, (2 * kReachOfClasses + 1) * (2 * kReachOfClasses + 1)> classes;
  int num = 0;

  Votes(const TileWindow<ColumnTile>& columns, Column c, int z, int reach,
        const GroundShape& shape) {
    for (int y = c.y - reach; y <= c.y + reach; ++y)
      for (int x = c.x - reach; x <= c.x + reach; ++x) {
        const auto& runs = columns.around({x, y}).runs;
        const int column = indexInTile({x, y});
        const Run* run = std::find_if(runs.begin(column), runs.end(column), [&](const Run& r) {
          return std::abs(r.top - z) <= shape.step;
        });
        if (run != runs.end(column)) classes[static_cast<std::size_t>(num++)] = run->topClass;
      }
  }
  int of(ClassId id) const {
    return static_cast<int>(std::count(classes.begin(), classes.begin() + num, id));
  }
  /** The most frequent one of those that are allowed, or of the others; or none. */
  std::optional<ClassId> mostFrequent(const GroundShape& shape, bool allowed) const {
    std::optional<ClassId> most;
    for (int i = 0; i < num; ++i) {
      const ClassId id = classes[static_cast<std::size_t>(i)];
      const bool isAllowed = shape.ranks[id] != colored_graph::kForbidden;
      if (isAllowed == allowed && (!most || of(id) > of(*most))) most = id;
    }
    return most;
  }
};

/** The class of a surface that is of a forbidden one: its own, unless most of what is around it is
 * of others. Or nothing around shares its own, and one of these is more frequent than each that is
 * forbidden: wrong labels differ, but real edges, ditches and verges go on. Where few columns next
 * to it have any, those beyond count, too. */
ClassId classAmong(const TileWindow<ColumnTile>& columns, Column c, const Surface& s,
                   const GroundShape& shape) {
  constexpr int kFew = 5;  // most of nine
  for (int reach = 1; reach <= kReachOfClasses; ++reach) {
    const Votes votes(columns, c, s.z, reach, shape);
    const auto isAllowed = [&](ClassId id) { return shape.ranks[id] != colored_graph::kForbidden; };
    const auto end = votes.classes.begin() + votes.num;
    const auto numAllowed = std::count_if(votes.classes.begin(), end, isAllowed);
    const auto best = votes.mostFrequent(shape, true), worst = votes.mostFrequent(shape, false);
    const bool isMost = 2 * numAllowed > votes.num;
    if (best && (isMost || (votes.of(s.classId) <= 1 && votes.of(*best) > votes.of(*worst))))
      return *best;
    if (votes.num >= kFew) break;
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

GapFillTile gapFillsFrom(const ScanGrid& columns, const SurfaceGrid& measured, Column tile,
                         const GroundShape& shape) {
  return GapFillSearch(columns, measured, tile, shape).from(tile);
}

namespace {

/** A surface that a fill offers to a column of its hole. */
struct Offer {
  int column, z;
  double width;  ///< of the gap
  Column from;
  int direction;
  ClassId classId;
};

/** A fill's columns from `low` to `high` that are in a tile; none if low > high. */
std::pair<int, int> columnsInTile(const GapFill& fill, Column tile) {
  const Column first = firstColumnOf(tile);
  const Direction& d = kDirections[fill.direction];
  int low = 1, high = fill.columns - 1;
  for (const auto& [offset, step] :
       {std::pair{first.x - fill.from.x, d.x}, {first.y - fill.from.y, d.y}}) {
    const int last = offset + kTileEdge - 1;
    if (step == 0 && (offset > 0 || last < 0)) return {1, 0};
    if (step == 0) continue;
    low = std::max(low, step > 0 ? offset : -last);
    high = std::min(high, step > 0 ? last : -offset);
  }
  return {low, high};
}

std::vector<Offer> offersTo(Column tile, const GapFillGrid& grid, const GroundShape& shape) {
  std::vector<Offer> offers;
  const int reach = reachOfGapFills(shape);
  const ColumnBox box{firstColumnOf(tile), lastColumnOf(tile)};
  for (const Column& from : tilesWithin({box}, {reach, reach, reach, 0})) {
    const GapFillTile* found = grid.find(from);
    if (!found || !found->box.overlaps(box)) continue;
    for (const GapFill& f : found->fills) {
      const auto [low, high] = columnsInTile(f, tile);
      const colored_graph::Rank rank = shape.ranks[f.classId];
      const bool known = f.width() <= shape.fillGap ||
                         (rank != colored_graph::kForbidden && rank == shape.ranks[f.otherClass]);
      for (int i = low; i <= high; ++i)
        offers.push_back({indexInTile(f.column(i)), f.height(i), f.width(), f.from, f.direction,
                          known ? f.nearerClass(i) : semantic_types::kNoClass});
    }
  }
  return offers;
}

auto narrowestFirst(const Offer& o) {
  return std::tie(o.column, o.width, o.z, o.from.y, o.from.x, o.direction);
}

/** The narrowest offer at each level of a column: between two surfaces there is room for the
 * vehicle, or one is an error. Sorted by column, then height. */
std::vector<Offer> bestOffers(std::vector<Offer> offers, int height) {
  std::stable_sort(offers.begin(), offers.end(), [](const Offer& l, const Offer& r) {
    return narrowestFirst(l) < narrowestFirst(r);
  });
  std::vector<Offer> best;
  std::size_t columnBegin = 0;
  for (const Offer& offer : offers) {
    if (!best.empty() && best.back().column != offer.column) columnBegin = best.size();
    const bool taken = std::any_of(best.begin() + columnBegin, best.end(), [&](const Offer& b) {
      return b.column == offer.column && std::abs(b.z - offer.z) <= height;
    });
    if (!taken) best.push_back(offer);
  }
  std::sort(best.begin(), best.end(), [](const Offer& l, const Offer& r) {
    return std::tie(l.column, l.z) < std::tie(r.column, r.z);
  });
  return best;
}

Surface surfaceOf(const Offer& offer) {
  Surface s;
  s.z = static_cast<std::uint16_t>(offer.z);
  s.classId = offer.classId;
  s.filled = true;
  return s;
}

bool isLower(const Surface& l, const Surface& r) { return l.z < r.z; }

/** Whether a column has more than one surface. */
bool hasLevels(const SurfaceTile& tile) {
  for (int column = 0; column < kTileColumns; ++column)
    if (tile.first[column + 1] > tile.first[column] + 1) return true;
  return false;
}

/** Takes the ghosts out of a column's surfaces, which are sorted.
 * \param surfaces in which they begin at `begin` */
void dropGhosts(const ColumnTile& columns, int column, std::ptrdiff_t begin,
                std::vector<Surface>& surfaces) {
  auto kept = surfaces.begin() + begin;
  for (auto s = kept; s != surfaces.end(); ++s)
    if (s + 1 == surfaces.end() || !columns.isGhost(column, s->z, (s + 1)->z)) *kept++ = *s;
  surfaces.erase(kept, surfaces.end());
}

SurfaceTile merged(const SurfaceTile& own, const std::vector<Offer>& offers,
                   const ColumnTile& columns) {
  SurfaceTile result;
  auto offer = offers.begin();
  for (int column = 0; column < kTileColumns; ++column) {
    const auto begin = static_cast<std::ptrdiff_t>(result.surfaces.size());
    for (const Surface& s : own.column(column)) result.surfaces.push_back(s);
    for (; offer != offers.end() && offer->column == column; ++offer)
      result.surfaces.push_back(surfaceOf(*offer));
    std::sort(result.surfaces.begin() + begin, result.surfaces.end(), isLower);
    dropGhosts(columns, column, begin, result.surfaces);
    result.first[column + 1] = static_cast<std::uint16_t>(result.surfaces.size());
  }
  result.surfaces.shrink_to_fit();
  return result;
}

}  // namespace

SurfaceTile filledSurfaces(const GapFillGrid& fills, const SurfaceGrid& measured,
                           const ScanGrid& columns, Column tile, const GroundShape& shape) {
  const SurfaceTile* own = measured.find(tile);
  const ColumnTile* scanned = columns.find(tile);
  const std::vector<Offer> offers = bestOffers(offersTo(tile, fills, shape), shape.height);
  if (own && offers.empty() && !hasLevels(*own)) return *own;
  return merged(own ? *own : SurfaceTile(), offers, scanned ? *scanned : ColumnTile());
}

}  // namespace semantic_planning
