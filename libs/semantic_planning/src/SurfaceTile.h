#pragma once
#include <semantic_planning/Surface.h>
#include <semantic_planning/TileGrid.h>

#include <array>
#include <cstdlib>
#include <vector>

namespace semantic_planning {

/** The surfaces of a tile, column by column, lowest first. */
struct SurfaceTile {
  std::vector<Surface> surfaces;
  std::array<std::uint16_t, kTileColumns + 1> first{};

  SurfaceRange column(int index) const {
    return {surfaces.data() + first[index], surfaces.data() + first[index + 1]};
  }
  bool operator==(const SurfaceTile& o) const { return surfaces == o.surfaces && first == o.first; }
};

using SurfaceGrid = TileGrid<SurfaceTile>;

inline SurfaceRange surfacesAt(const SurfaceGrid& grid, Column c) {
  const SurfaceTile* tile = grid.find(tileOf(c));
  return tile ? tile->column(indexInTile(c)) : SurfaceRange();
}

/** The column's surface nearest to z, at most `tolerance` off, the lower one on a tie; or null. */
inline const Surface* surfaceNear(const SurfaceGrid& grid, Column c, int z, int tolerance) {
  const Surface* best = nullptr;
  for (const Surface& s : surfacesAt(grid, c)) {
    const int difference = std::abs(int(s.z) - z);
    if (difference <= tolerance && (!best || difference < std::abs(int(best->z) - z))) best = &s;
  }
  return best;
}

/** f(column) for all columns of a tile. */
template <class F>
void forColumnsOf(Column tile, F f) {
  const Column low = firstColumnOf(tile);
  for (int y = 0; y < kTileEdge; ++y)
    for (int x = 0; x < kTileEdge; ++x) f(Column{low.x + x, low.y + y});
}

/** f(column) for all columns of a tile and those at most `margin` columns outside of it. */
template <class F>
void forColumnsAround(Column tile, int margin, F f) {
  const Column low = firstColumnOf(tile);
  for (int y = -margin; y < kTileEdge + margin; ++y)
    for (int x = -margin; x < kTileEdge + margin; ++x) f(Column{low.x + x, low.y + y});
}

}  // namespace semantic_planning
