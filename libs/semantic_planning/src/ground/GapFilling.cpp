#include "GapFilling.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "ColumnBox.h"

namespace semantic_planning {
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
    const std::vector<GapFill>* fills = grid.find(from);
    if (!fills) continue;
    for (const GapFill& f : *fills) {
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

/** The narrowest offer at each height of a column, about. Sorted by column, then height. */
std::vector<Offer> bestOffers(std::vector<Offer> offers, int step) {
  std::stable_sort(offers.begin(), offers.end(), [](const Offer& l, const Offer& r) {
    return narrowestFirst(l) < narrowestFirst(r);
  });
  std::vector<Offer> best;
  std::size_t columnBegin = 0;
  for (const Offer& offer : offers) {
    if (!best.empty() && best.back().column != offer.column) columnBegin = best.size();
    const bool taken = std::any_of(best.begin() + columnBegin, best.end(), [&](const Offer& b) {
      return b.column == offer.column && std::abs(b.z - offer.z) <= step;
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

/** A tile's own surfaces and what is offered. */
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
  const std::vector<Offer> offers = bestOffers(offersTo(tile, fills, shape), shape.step);
  if (own && offers.empty() && !hasLevels(*own)) return *own;
  return merged(own ? *own : SurfaceTile(), offers, scanned ? *scanned : ColumnTile());
}

}  // namespace semantic_planning
