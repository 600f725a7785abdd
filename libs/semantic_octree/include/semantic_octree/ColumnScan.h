#pragma once
#include <semantic_octree/Column.h>
#include <semantic_octree/SemanticOcTree.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

/** \file
 * A map column by column: what ground is read from. */

namespace semantic_octree {

/** Occupied voxels on top of each other without a gap. */
struct Run {
  std::uint16_t bottom = 0, top = 0;            ///< keys of its voxels
  ClassId topClass = semantic_types::kNoClass;  ///< likeliest class of its highest voxel
  bool operator==(const Run& o) const {
    return bottom == o.bottom && top == o.top && topClass == o.topClass;
  }
};

/** Free voxels on top of each other without a gap, all of them sure or none. */
struct Space {
  std::uint16_t bottom = 0, top = 0;  ///< keys of its voxels
  bool isSure = false;                ///< beams of more than one scan passed
  bool operator==(const Space& o) const {
    return bottom == o.bottom && top == o.top && isSure == o.isSure;
  }
};

/** Things of each column of a tile, column by column, lowest first. */
template <class T>
struct ByColumn {
  std::vector<T> all;
  std::array<std::uint16_t, kTileColumns + 1> first{};

  const T* begin(int column) const { return all.data() + first[column]; }
  const T* end(int column) const { return all.data() + first[column + 1]; }
  bool sameColumn(int column, const ByColumn& o) const {
    return std::equal(begin(column), end(column), o.begin(column), o.end(column));
  }
};

/** What the map holds in a tile of columns; without anything said, that is nothing. Columns are
 * given by indexInTile(), heights as keys. */
struct ColumnTile {
  ByColumn<Run> runs;
  ByColumn<Space> spaces;

  bool sameColumn(int column, const ColumnTile& o) const {
    return runs.sameColumn(column, o.runs) && spaces.sameColumn(column, o.spaces);
  }
  /** Whether ground between two heights would hang over a drop of more than a step. Then sure free
   * space goes down from `high` to a step below `low` without a gap, and what is under that is
   * known. The beam of a ghost (a return that came by way of a mirror) frees voxels below the
   * ground, too, but seldom twice. Where nothing is sure, free space below counts if it is near and
   * too high for a single flat beam: three voxels.
   * \param step, near voxels */
  bool isOverDrop(int column, int low, int high, int step, int near) const;
  /** Whether what is at height `low` is a ghost. Then more than one scan saw what is above `high`,
   * where there is ground. Of the space between, the map saw less than half, and nothing surely. */
  bool isGhost(int column, int low, int high) const;
  /** Bottom of the lowest run that is no ghost under the next one, or under sure space from more
   * than `margin` above; else kNumKeys. */
  int floorOf(int column, int margin) const;

 private:
  bool isKnown(int column, int z) const;
  bool isSureFrom(int column, int low, int high) const;
};

/** Reads tiles of a map, which must outlive it. */
class ColumnScanner {
 public:
  explicit ColumnScanner(const SemanticOcTree& map);
  ColumnTile scan(Column tile) const;

 private:
  const SemanticOcTree& m_map;
  float m_sure;  ///< log-odds of sure free voxels, at most
};

}  // namespace semantic_octree
