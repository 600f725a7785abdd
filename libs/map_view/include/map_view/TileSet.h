#pragma once
#include <map_view/CellSource.h>
#include <map_view/OrbitCamera.h>

#include <array>
#include <set>
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

/** Where a map is looked at from, and how finely. */
struct View {
  OrbitCamera camera;
  int width = 1280, height = 720;  ///< pixels
  /** Tiles are drawn finer while their cells are larger than this. */
  double pixelsPerCell = 4;
};

/** The tiles in which something that is shown may be seen, the nearest first: coarse ones far away,
 * fine ones near. No place is in two of them. */
std::vector<Tile> tilesSeen(const SemanticOcTree& map, const View& view, const CellLook& look);

/** Remembers whose meshes are as they should be. */
class FreshTiles {
 public:
  bool contains(const Tile& tile) const { return m_tiles.count(tile) > 0; }
  void add(const Tile& tile) { m_tiles.insert(tile); }
  void remove(const Tile& tile) { m_tiles.erase(tile); }
  /** All cells look otherwise from now on. */
  void clear() { m_tiles.clear(); }
  /** What is in some boxes has changed: takes out all tiles that show it or its neighbors' sides,
   * and perhaps others nearby. */
  void remove(const std::vector<KeyBox>& boxes);

 private:
  std::set<Tile> m_tiles;
};

}  // namespace map_view
