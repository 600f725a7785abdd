#pragma once

namespace semantic_octree {

/** A column of the map: keys of its voxels in x and y. Differences may leave the range of keys. */
struct Column {
  int x = 0, y = 0;
  bool operator==(const Column& o) const { return x == o.x && y == o.y; }
  bool operator<(const Column& o) const { return x != o.x ? x < o.x : y < o.y; }
};

/** Columns come in square tiles of this edge, so that what changed can be told by tiles. */
constexpr int kTileEdge = 16;
constexpr int kTileColumns = kTileEdge * kTileEdge;

inline Column tileOf(Column c) { return {c.x >> 4, c.y >> 4}; }
inline Column firstColumnOf(Column tile) { return {tile.x * kTileEdge, tile.y * kTileEdge}; }
inline Column lastColumnOf(Column tile) {
  return {tile.x * kTileEdge + kTileEdge - 1, tile.y * kTileEdge + kTileEdge - 1};
}
inline int indexInTile(Column c) { return (c.y & 15) * kTileEdge + (c.x & 15); }

}  // namespace semantic_octree
