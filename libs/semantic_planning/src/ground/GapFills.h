#pragma once
#include <semantic_octree/ColumnScan.h>

#include <array>
#include <vector>

#include "SurfaceTile.h"

namespace semantic_planning {

using semantic_octree::ColumnTile;
using semantic_octree::Run;
using ScanGrid = ColumnGrid<ColumnTile>;

/** Columns around one that tell what class it has. */
constexpr int kReachOfClasses = 2;

/** Top voxels with enough free space above. A forbidden one takes the class of most drivable ones
 * around, if these or that class outnumber the forbidden: single wrong labels close no road. */
SurfaceTile measuredSurfaces(const ScanGrid& columns, Column tile, const GroundShape& shape);

/** Directions of gap fills; the opposite ones are the same fills from their other ends. */
struct Direction {
  int x, y;
  double length;
};
constexpr std::array<Direction, 4> kDirections = {
    {{1, 0, 1}, {0, 1, 1}, {1, 1, 1.41421356}, {-1, 1, 1.41421356}}};

/** A line over a hole, from a surface to another one, along which the ground is filled in. */
struct GapFill {
  Column from;
  int direction = 0;                ///< of kDirections
  int columns = 1;                  ///< from one end to the other
  std::uint16_t z = 0, otherZ = 0;  ///< of both ends
  ClassId classId{}, otherClass{};

  Column column(int i) const {
    return {from.x + i * kDirections[direction].x, from.y + i * kDirections[direction].y};
  }
  double width() const { return (columns - 1) * kDirections[direction].length; }
  int height(int i) const;
  ClassId nearerClass(int i) const { return 2 * i <= columns ? classId : otherClass; }
};

/** Fills that begin in one tile, and what they cross. */
struct GapFillTile {
  std::vector<GapFill> fills;
  ColumnBox box;
};
using GapFillGrid = ColumnGrid<GapFillTile>;

/** How many columns a fill goes from its first end, at most. */
inline int reachOfGapFills(const GroundShape& shape) {
  return static_cast<int>(shape.widestGap) + 1;
}

/** The fills whose first end is in a tile. Each leads from a surface that lacks a neighbor to the
 * next one at about its height. Nothing stands in between, and no drop was seen below. */
GapFillTile gapFillsFrom(const ScanGrid& columns, const SurfaceGrid& measured, Column tile,
                         const GroundShape& shape);

/** The measured surfaces of a tile with those that fill its holes: of fills at about one height
 * the shortest. Without ghosts: surfaces below others, see ColumnTile. \param fills of the tile and
 * of all within their reach */
SurfaceTile filledSurfaces(const GapFillGrid& fills, const SurfaceGrid& measured,
                           const ScanGrid& columns, Column tile, const GroundShape& shape);

}  // namespace semantic_planning
