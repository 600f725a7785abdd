#pragma once
#include <semantic_planning/ground/Ground.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include "ground/SurfaceTile.h"
#include "roadmap/PlanningRegion.h"

namespace semantic_planning {

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
  static constexpr std::int32_t kNone = -1;

  /** Names a surface. Sorted by tile, column, and height. */
  struct Cell {
    std::int32_t tile = kNone;
    std::uint16_t index = 0;  ///< in the tile
    explicit operator bool() const { return tile != kNone; }
    bool operator==(const Cell& o) const { return tile == o.tile && index == o.index; }
    bool operator<(const Cell& o) const { return tile != o.tile ? tile < o.tile : index < o.index; }
  };

  struct Label {
    Cost cost = kUnreached;
    std::int32_t tileBefore = kNone;
    std::uint16_t indexBefore = 0;
    std::int8_t step = 0;  ///< with which it was reached
    bool done = false;
    Cell before() const { return {tileBefore, indexBefore}; }
  };

  /** Where a surface is. */
  struct Place {
    Column column;
    const Surface* surface = nullptr;
    Cell cell;
  };

  /** \param ground must outlive the field. */
  explicit RelaxedField(const Ground& ground);

  /** The column's drivable surface nearest to a height, at most `tolerance` voxels off; or null. */
  const Surface* near(Column c, int z, int tolerance) const;
  /** The place of that; none: without a surface. */
  Place placeNear(Column c, int z, int tolerance) const;
  Place placeOf(const Cell& cell) const;
  Label& label(const Cell& cell);

 private:
  struct Tile {
    const SurfaceTile* surfaces = nullptr;
    Column place;
    std::int32_t number = kNone;
    std::vector<Label> labels;  ///< of its surfaces; empty: nothing got there
  };
  Tile& tile(const Cell& cell) const { return *m_numbered[static_cast<std::size_t>(cell.tile)]; }

  ColumnGrid<Tile> m_tiles;
  std::vector<Tile*> m_numbered;
};

}  // namespace semantic_planning
