#include "Bridging.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace semantic_planning {
namespace {

struct Direction {
  int x, y;
  double length;
};
constexpr std::array<Direction, 4> kDirections = {
    {{1, 0, 1}, {0, 1, 1}, {1, 1, 1.41421356}, {-1, 1, 1.41421356}}};

/** A surface that a line offers to a hole. */
struct Offer {
  int column, z;
  double width;  ///< of the gap
  ClassId classId;
};

class TileBridging {
 public:
  TileBridging(const ColumnGrid& columns, const SurfaceGrid& measured, Column tile,
               const GroundShape& shape)
      : m_columns(columns), m_measured(measured), m_tile(tile), m_shape(shape) {}

  std::vector<Offer> offers() {
    const int reach = static_cast<int>(m_shape.widestGap);
    forColumnsAround(m_tile, reach, [&](Column c) {
      for (const Direction& d : kDirections)
        if (reachesTile(c, d, reach))
          for (const Surface& s : surfacesAt(m_measured, c)) lookAcross(c, s, d);
    });
    return std::move(m_offers);
  }

 private:
  static Column along(Column c, const Direction& d, int n) {
    return {c.x + n * d.x, c.y + n * d.y};
  }

  /** Whether one of the next `reach` columns in a direction is in the tile. */
  bool reachesTile(Column from, const Direction& d, int reach) const {
    const Column first = firstColumnOf(m_tile);
    int low = 1, high = reach;
    for (const auto& [offset, step] : {std::pair{first.x - from.x, d.x}, {first.y - from.y, d.y}}) {
      const int last = offset + kTileEdge - 1;
      if (step == 0 && (offset > 0 || last < 0)) return false;
      if (step == 0) continue;
      low = std::max(low, step > 0 ? offset : -last);
      high = std::min(high, step > 0 ? last : -offset);
    }
    return low <= high;
  }

  /** From a surface whose neighbor is missing to the next surface on the line. */
  void lookAcross(Column from, const Surface& s, const Direction& d) {
    if (surfaceNear(m_measured, along(from, d, 1), s.z, m_shape.step)) return;
    for (int n = 2; (n - 1) * d.length <= m_shape.widestGap; ++n) {
      const int tolerance = m_shape.step + static_cast<int>(n * d.length * m_shape.rise);
      const Surface* other = surfaceNear(m_measured, along(from, d, n), s.z, tolerance);
      if (!other) continue;
      bridge(from, s, *other, d, n);
      return;
    }
  }

  void bridge(Column from, const Surface& a, const Surface& b, const Direction& d, int n) {
    const double width = (n - 1) * d.length;
    const auto height = [&](int m) {
      return a.z + int(std::lround(double(int(b.z) - a.z) * m / n));
    };
    for (int m = 1; m < n; ++m)
      if (!isHole(along(from, d, m), height(m))) return;
    for (int m = 1; m < n; ++m) {
      const Column c = along(from, d, m);
      if (!(tileOf(c) == m_tile)) continue;
      const ClassId nearer = 2 * m <= n ? a.classId : b.classId;
      const bool known = width <= m_shape.bridgeGap;
      m_offers.push_back({indexInTile(c), height(m), width, known ? nearer : ClassId{}});
    }
  }

  /** Nothing stands there, and nothing was seen below. */
  bool isHole(Column c, int z) const {
    const ColumnTile* tile = m_columns.find(tileOf(c));
    if (!tile) return true;
    const int column = indexInTile(c);
    if (tile->lowestFree[column] < z - m_shape.step) return false;
    for (const Run* run = tile->begin(column); run != tile->end(column); ++run)
      if (run->bottom <= z + m_shape.height && run->top >= z - m_shape.step) return false;
    return true;
  }

  const ColumnGrid& m_columns;
  const SurfaceGrid& m_measured;
  const Column m_tile;
  const GroundShape& m_shape;
  std::vector<Offer> m_offers;
};

/** Of the offers at about one height in a column, the narrowest. Sorted by column, then height. */
std::vector<Offer> bestOffers(std::vector<Offer> offers, int step) {
  std::stable_sort(offers.begin(), offers.end(), [](const Offer& l, const Offer& r) {
    return std::tie(l.column, l.width, l.z) < std::tie(r.column, r.width, r.z);
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

Surface bridgingSurface(const Offer& offer) {
  Surface s;
  s.z = static_cast<std::uint16_t>(offer.z);
  s.classId = offer.classId;
  s.bridged = true;
  return s;
}

bool isLower(const Surface& l, const Surface& r) { return l.z < r.z; }

}  // namespace

SurfaceTile measuredSurfaces(const ColumnTile& columns, const GroundShape& shape) {
  SurfaceTile tile;
  for (int column = 0; column < kTileColumns; ++column) {
    for (const Run* run = columns.begin(column); run != columns.end(column); ++run) {
      const Run* above = run + 1;
      if (above != columns.end(column) && above->bottom <= run->top + shape.height) continue;
      Surface s;
      s.z = run->top;
      s.classId = run->topClass;
      tile.surfaces.push_back(s);
    }
    tile.first[column + 1] = static_cast<std::uint16_t>(tile.surfaces.size());
  }
  return tile;
}

SurfaceTile bridgedSurfaces(const ColumnGrid& columns, const SurfaceGrid& measured, Column tile,
                            const GroundShape& shape) {
  const std::vector<Offer> offers =
      bestOffers(TileBridging(columns, measured, tile, shape).offers(), shape.step);
  const SurfaceTile* own = measured.find(tile);
  SurfaceTile result;
  auto offer = offers.begin();
  for (int column = 0; column < kTileColumns; ++column) {
    const auto begin = static_cast<std::ptrdiff_t>(result.surfaces.size());
    if (own)
      for (const Surface& s : own->column(column)) result.surfaces.push_back(s);
    for (; offer != offers.end() && offer->column == column; ++offer)
      result.surfaces.push_back(bridgingSurface(*offer));
    std::sort(result.surfaces.begin() + begin, result.surfaces.end(), isLower);
    result.first[column + 1] = static_cast<std::uint16_t>(result.surfaces.size());
  }
  return result;
}

}  // namespace semantic_planning
