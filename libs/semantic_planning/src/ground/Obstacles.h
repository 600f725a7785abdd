#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "GroundShape.h"
#include "SurfaceTile.h"

namespace semantic_planning {

/** Where the vehicle must not be: for each column of a tile the heights (keys) about which it is an
 * obstacle. */
struct ObstacleTile {
  std::vector<std::uint16_t> heights;  ///< column by column, lowest first
  std::array<std::uint16_t, kTileColumns + 1> first{};

  const std::uint16_t* begin(int column) const { return heights.data() + first[column]; }
  const std::uint16_t* end(int column) const { return heights.data() + first[column + 1]; }
  bool any(int column) const { return first[column] != first[column + 1]; }
  bool sameColumn(int column, const ObstacleTile& o) const {
    return std::equal(begin(column), end(column), o.begin(column), o.end(column));
  }
};

using ObstacleGrid = ColumnGrid<ObstacleTile>;

/** A surface that is not free (not drivable, or to be kept off) is an obstacle; and so is a column
 * at the height of free ground next to it, if it has no surface within a step of that.
 * \param surfaces with `drivable` set. */
ObstacleTile obstaclesIn(const SurfaceGrid& surfaces, Column tile, const GroundShape& shape);

}  // namespace semantic_planning
