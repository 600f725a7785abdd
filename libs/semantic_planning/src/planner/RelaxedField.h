#pragma once
#include <semantic_planning/ground/Ground.h>
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "ground/GroundTiles.h"

namespace semantic_planning {

/** Hands out what has the least key, and of that the least value; no key may be less than the last
 * one that it handed out. Keys that differ from that in the same highest bit share a bucket, which
 * is dealt out when its turn comes (the radix heap of Ahuja et al., "Faster algorithms for the
 * shortest path problem", 1990): that touches less memory than a binary heap. */
template <class Value>
class MonotoneQueue {
 public:
  using Key = std::int64_t;
  using Entry = std::pair<Key, Value>;

  bool empty() const { return m_size == 0; }
  void push(Key key, const Value& value) {
    m_buckets[bucketOf(key)].emplace_back(key, value);
    if (key == m_last) std::push_heap(m_buckets[0].begin(), m_buckets[0].end(), IsAfter());
    ++m_size;
  }
  const Entry& top() {
    deal();
    return m_buckets[0].front();
  }
  Entry pop() {
    deal();
    std::pop_heap(m_buckets[0].begin(), m_buckets[0].end(), IsAfter());
    const Entry entry = m_buckets[0].back();
    m_buckets[0].pop_back();
    --m_size;
    return entry;
  }

 private:
  struct IsAfter {
    bool operator()(const Entry& a, const Entry& b) const { return b.second < a.second; }
  };

  std::size_t bucketOf(Key key) const {
    const auto differs = static_cast<std::uint64_t>(key ^ m_last);
    return differs == 0 ? 0 : 64 - static_cast<std::size_t>(__builtin_clzll(differs));
  }

  /** Fills the first bucket, that of the least key. */
  void deal() {
    if (!m_buckets[0].empty()) return;
    const auto bucket = std::find_if(m_buckets.begin() + 1, m_buckets.end(),
                                     [](const auto& entries) { return !entries.empty(); });
    m_last = std::min_element(bucket->begin(), bucket->end(), [](const Entry& a, const Entry& b) {
               return a.first < b.first;
             })->first;
    for (const Entry& e : *bucket) m_buckets[bucketOf(e.first)].push_back(e);
    bucket->clear();
    std::make_heap(m_buckets[0].begin(), m_buckets[0].end(), IsAfter());
  }

  std::array<std::vector<Entry>, 65> m_buckets;  ///< by the highest bit that differs; 0: none
  std::size_t m_size = 0;
  Key m_last = 0;
};

/** Lengths of steps to neighbors on a grid, in fifths of its spacing. */
constexpr std::int64_t kStraightStep = 5, kDiagonalStep = 7;

/** Least length of steps between two columns. */
inline std::int64_t stepsBetween(Column a, Column b) {
  const std::int64_t dx = std::abs(a.x - b.x), dy = std::abs(a.y - b.y);
  return kStraightStep * std::max(dx, dy) + (kDiagonalStep - kStraightStep) * std::min(dx, dy);
}

/** What a search from one drivable surface of a region to the next knows about each of them. Only
 * tiles that it gets to take memory: a way along a road is a small part of its region. */
class RelaxedField {
 public:
  using Cost = std::int64_t;
  static constexpr Cost kUnreached = std::numeric_limits<Cost>::max();

  /** Names a surface. Sorted by tile, column, and height. */
  struct Cell {
    std::int32_t tile = SurfaceGrid::kNoTile;
    std::uint16_t index = 0;  ///< in the tile
    std::uint8_t column = 0;  ///< of the tile, which the index says as well, but not as soon
    explicit operator bool() const { return tile != SurfaceGrid::kNoTile; }
    bool operator==(const Cell& o) const { return tile == o.tile && index == o.index; }
    bool operator<(const Cell& o) const { return tile != o.tile ? tile < o.tile : index < o.index; }
  };

  struct Label {
    Cost cost = kUnreached;
    Cell before;
  };

  /** Where a surface is. */
  struct Place {
    Column column;
    const Surface* surface = nullptr;
    Cell cell;
  };

  /** \param ground must outlive the field. */
  explicit RelaxedField(const Ground& ground)
      : m_surfaces(ground.layers().surfaces()), m_labels(m_surfaces.size()) {}

  /** The column's drivable surface nearest to a height, at most `tolerance` voxels off; or null. */
  const Surface* near(Column c, int z, int tolerance) const;
  /** The place of that; none: without a surface. */
  Place placeNear(Column c, int z, int tolerance) const;
  Place placeOf(const Cell& cell) const;
  Label& label(const Cell& cell);

 private:
  const SurfaceGrid& m_surfaces;
  std::vector<std::unique_ptr<Label[]>> m_labels;  ///< by tile, of its surfaces; null: none reached
};

inline const Surface* RelaxedField::near(Column c, int z, int tolerance) const {
  return placeNear(c, z, tolerance).surface;
}

inline RelaxedField::Place RelaxedField::placeNear(Column c, int z, int tolerance) const {
  const std::int32_t number = m_surfaces.numberOf(tileOf(c));
  const SurfaceTile* const tile = number == SurfaceGrid::kNoTile ? nullptr : m_surfaces.at(number);
  if (!tile) return {};
  const int column = indexInTile(c);
  const Surface* best = nullptr;
  int least = tolerance + 1;
  for (const Surface& s : tile->column(column)) {
    const int off = std::abs(s.z - z);
    if (s.drivable && off < least) best = &s, least = off;
  }
  if (!best) return {};
  const auto index = static_cast<std::uint16_t>(best - tile->surfaces.data());
  return {c, best, {number, index, static_cast<std::uint8_t>(column)}};
}

inline RelaxedField::Place RelaxedField::placeOf(const Cell& cell) const {
  const Column low = firstColumnOf(m_surfaces.tileOfNumber(cell.tile));
  return {{low.x + cell.column % kTileEdge, low.y + cell.column / kTileEdge},
          &m_surfaces.at(cell.tile)->surfaces[cell.index],
          cell};
}

inline RelaxedField::Label& RelaxedField::label(const Cell& cell) {
  std::unique_ptr<Label[]>& labels = m_labels[static_cast<std::size_t>(cell.tile)];
  if (!labels) labels = std::make_unique<Label[]>(m_surfaces.at(cell.tile)->surfaces.size());
  return labels[cell.index];
}

/** The way of a vehicle that could turn on the spot. */
struct RelaxedPath {
  std::vector<PathPoint> path;  ///< headings are those of travel; empty if there is no way
  double price = 0;             ///< meters; hardly any path of the vehicle costs less
  /** Without a way: the place nearest to the goal that can be reached. */
  std::optional<mrpt::math::TPoint2D> nearest;
};

/** What a length of each rank counts, driving it included, in sixteenths of its own. */
constexpr std::int64_t kWeightOfLength = 16;
std::vector<std::int64_t> weightsOfRanks(const colored_graph::ClassOrder& order);

/** From column to column in eight directions, wherever there is ground: the way of least price. It
 * knows no turning radius. \param overForbidden also over what the order forbids, at the price of
 * the worst rank */
RelaxedPath searchRelaxed(const CollisionChecker& checker, const GroundPose& start,
                          const GroundPose& goal, bool overForbidden = false);

}  // namespace semantic_planning
