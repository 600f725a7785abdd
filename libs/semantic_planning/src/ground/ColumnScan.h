#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_planning/ground/Surface.h>

#include <algorithm>
#include <array>
#include <vector>
#include "ColumnGrid.h"

namespace semantic_planning {

/** Occupied voxels on top of each other without a gap. */
struct Run {
  std::uint16_t bottom = 0, top = 0;  ///< keys of its voxels
  ClassId topClass = semantic_types::kNoClass;
  bool operator==(const Run& o) const {
    return bottom == o.bottom && top == o.top && topClass == o.topClass;
  }
};

constexpr std::uint16_t kNeverFree = 0xffff;

/** What the map holds in a tile of columns; without anything said, that is nothing. */
struct ColumnTile {
  std::vector<Run> runs;  ///< column by column, lowest first
  std::array<std::uint16_t, kTileColumns + 1> first{};
  /** Key of each column's lowest free voxel. */
  std::array<std::uint16_t, kTileColumns> lowestFree;

  ColumnTile() { lowestFree.fill(kNeverFree); }
  const Run* begin(int column) const { return runs.data() + first[column]; }
  const Run* end(int column) const { return runs.data() + first[column + 1]; }
  bool sameColumn(int column, const ColumnTile& o) const {
    return lowestFree[column] == o.lowestFree[column] &&
           std::equal(begin(column), end(column), o.begin(column), o.end(column));
  }
};

/** Reads a tile. */
ColumnTile scanColumns(const semantic_octree::SemanticOcTree& map, Column tile);

}  // namespace semantic_planning
