#pragma once
#include <semantic_octree/store/TileCodes.h>

#include <cstdint>
#include <unordered_set>
#include <vector>

namespace semantic_octree {

/** Tiles of 8 x 8 x 8 voxels in which something changed since somebody last asked. */
class TouchedTiles {
 public:
  static constexpr int kDepth = kTileDepth;

  /** A cube of a tile's size or larger. */
  void add(const Cell& cube);
  /** Lowest key of each tile, sorted; forgets them. */
  std::vector<octomap::OcTreeKey> take();

 private:
  std::unordered_set<std::uint64_t> m_tiles;
};

}  // namespace semantic_octree
