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
  /** Whether anything is known of a voxel. */
  bool isKnown(int column, int z) const;
  /** Whether free space goes down without a gap from height `from` to `to`, at which it is sure or,
   * like what is more than `margin` above `from`, seen by one scan only. The beam of a ghost (a
   * return that came by way of a mirror) frees voxels, too, but few, and seldom twice. */
  bool isOpen(int column, int from, int to, int margin) const;
  /** Whether the map saw the space between two heights: some of it surely, or half of it. If not,
   * what is at the lower one, under ground at the higher one, is a ghost. */
  bool isSeenBetween(int column, int low, int high) const;
  /** Bottom of the lowest run that is no ghost: under the next run, or under sure space that begins
   * more than `margin` above, the map saw something; kNumKeys if there is none. */
  int floorOf(int column, int margin) const;
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
