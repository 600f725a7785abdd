#pragma once
#include <map_view/CellSource.h>

#include <array>
#include <vector>

namespace map_view {

/** Cells along the edge of a tile; those of the finest tiles are voxels. */
constexpr int kCellsPerTile = 64;
constexpr int kTileLevels = 6;  ///< between a tile and its cells
/** Depth of the finest tiles. */
constexpr int kFinestTiles = semantic_octree::kTreeDepth - kTileLevels;

/** A cube of depth 0 to kFinestTiles that is drawn at once, with cells of kCellsPerTile to its
 * edge. */
struct Tile : Cube {
  int cellDepth() const { return depth + kTileLevels; }
  int cellEdge() const { return edge() / kCellsPerTile; }
  /** The next coarser one; depth > 0. */
  Tile around() const { return {Cube::around(lowest, depth - 1)}; }
  bool operator<(const Tile& o) const {
    const auto tuple = [](const Tile& t) {
      return std::make_tuple(t.depth, t.lowest.x(), t.lowest.y(), t.lowest.z());
    };
    return tuple(*this) < tuple(o);
  }
};

/** A side of a cell. */
struct Face {
  /** m, map frame; counterclockwise seen from outside. */
  std::array<Eigen::Vector3f, 4> corners;
  /** With light from above; corners and creases are darker. */
  std::array<Color, 4> colors;
};

/** Where the sides of cells look: up, down, +x, -x, +y, -y. */
constexpr std::size_t kNumDirections = 6;
Eigen::Vector3i normalOf(std::size_t direction);

/** What is seen of a tile: the sides of its cells that no neighbor hides, by where they look. */
struct TileMesh {
  std::array<std::vector<Face>, kNumDirections> occupied;
  /** The faces of free cells and of unknown space. */
  std::vector<Face> translucent;
};

/** Whether sides of a tile's cells that look there may be seen from a place (m, map frame). */
bool mayFace(const Tile& tile, std::size_t direction, const Eigen::Vector3d& place,
             double voxelSize);

/** The mesh of a tile. Cells that reach into other tiles give their part in this one. */
TileMesh meshOf(const Tile& tile, const CellSource& cells, const CellLook& look);

}  // namespace map_view
