#pragma once
#include <colored_graph/ClassOrder.h>
#include <semantic_planning/ground/GroundOptions.h>
#include <semantic_planning/ground/Surface.h>
#include <semantic_planning/vehicle/VehicleOptions.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "ColumnGrid.h"

namespace semantic_planning {

/** Vehicle and options in voxels. */
struct GroundShape {
  GroundShape(const VehicleOptions& vehicle, const GroundOptions& options,
              const colored_graph::ClassOrder& order, double voxelSize);

  int height;      ///< free voxels above a surface
  int step;        ///< from column to column
  double fillGap;  ///< between the surfaces on both sides
  double widestGap;
  double rise;   ///< of a drivable slope, voxels per voxel
  int baseline;  ///< columns to each side over which slope is measured
  int largestClearance;
  std::vector<colored_graph::Rank> ranks;  ///< by class id
  std::vector<bool> keepOff;
};

/** The tiles around one tile, to look columns up often. Valid while the grid's rectangle is. */
template <class T>
class TileWindow {
 public:
  /** \param reach columns outside of the tile that are asked for, at most */
  TileWindow(const ColumnGrid<T>& grid, Column tile, int reach) {
    static const T none{};
    const int ring = (reach + kTileEdge - 1) / kTileEdge;
    m_first = {tile.x - ring, tile.y - ring};
    m_width = 2 * ring + 1;
    for (int y = 0; y < m_width; ++y)
      for (int x = 0; x < m_width; ++x) {
        const T* found = grid.find({m_first.x + x, m_first.y + y});
        m_tiles.push_back(found ? found : &none);
      }
  }

  /** The tile that holds a column; an empty one where the grid has none. */
  const T& around(Column c) const {
    const Column tile = tileOf(c);
    return *m_tiles[(tile.y - m_first.y) * m_width + tile.x - m_first.x];
  }

 private:
  Column m_first;
  int m_width;
  std::vector<const T*> m_tiles;
};

/** The surfaces of a tile, column by column, lowest first. */
struct SurfaceTile {
  std::vector<Surface> surfaces;
  std::array<std::uint16_t, kTileColumns + 1> first{};

  SurfaceRange column(int index) const {
    return {surfaces.data() + first[index], surfaces.data() + first[index + 1]};
  }
  /** Whether surfaces are at the same places, whatever else is known of them. */
  bool sameColumn(int index, const SurfaceTile& o) const {
    const SurfaceRange l = column(index), r = o.column(index);
    return std::equal(l.begin(), l.end(), r.begin(), r.end(),
                      [](const Surface& a, const Surface& b) {
                        return a.z == b.z && a.classId == b.classId && a.filled == b.filled;
                      });
  }
};

using SurfaceGrid = ColumnGrid<SurfaceTile>;
using SurfaceWindow = TileWindow<SurfaceTile>;

inline SurfaceRange surfacesAt(const SurfaceGrid& grid, Column c) {
  const SurfaceTile* tile = grid.find(tileOf(c));
  return tile ? tile->column(indexInTile(c)) : SurfaceRange();
}

inline SurfaceRange surfacesAt(const SurfaceWindow& window, Column c) {
  return window.around(c).column(indexInTile(c));
}

/** A column's surface nearest to z, at most `tolerance` off, the lower one on a tie; or
 * null. */
inline const Surface* surfaceNear(SurfaceRange column, int z, int tolerance) {
  const Surface* best = nullptr;
  for (const Surface& s : column) {
    const int difference = std::abs(int(s.z) - z);
    if (difference <= tolerance && (!best || difference < std::abs(int(best->z) - z))) best = &s;
  }
  return best;
}

template <class Surfaces>
const Surface* surfaceNear(const Surfaces& surfaces, Column c, int z, int tolerance) {
  return surfaceNear(surfacesAt(surfaces, c), z, tolerance);
}

/** f(column) for all columns of a tile. */
template <class F>
void forColumnsOf(Column tile, F f) {
  const Column low = firstColumnOf(tile);
  for (int y = 0; y < kTileEdge; ++y)
    for (int x = 0; x < kTileEdge; ++x) f(Column{low.x + x, low.y + y});
}

/** f(column, index) for all surfaces of a tile, in their order. */
template <class F>
void forSurfacesOf(Column tile, const SurfaceTile& surfaces, F f) {
  forColumnsOf(tile, [&](Column c) {
    const int index = indexInTile(c);
    for (std::size_t i = surfaces.first[index]; i < surfaces.first[index + 1]; ++i) f(c, i);
  });
}

}  // namespace semantic_planning
