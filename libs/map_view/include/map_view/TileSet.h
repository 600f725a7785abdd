#pragma once
#include <map_view/OrbitCamera.h>
#include <map_view/TileMesh.h>

#include <set>
#include <vector>

namespace map_view {

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
  /** What is in some boxes has changed: takes out all tiles that show it, or the sides of cells
   * next to it, and perhaps others nearby. */
  void remove(const std::vector<KeyBox>& boxes);

 private:
  std::set<Tile> m_tiles;
};

}  // namespace map_view
