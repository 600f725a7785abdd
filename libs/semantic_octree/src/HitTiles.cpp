#include <semantic_octree/store/HitTiles.h>

namespace semantic_octree {

void HitTiles::cover(std::size_t numTiles) {
  m_indices.assign(numTiles, 0);
  m_tiles.assign(1, Tile());
}

std::uint32_t HitTiles::rank() {
  std::uint32_t next = 0;
  for (Tile& tile : m_tiles)
    for (int w = 0; w < ScanGrid::kWords; ++w) {
      tile.ranks[w] = next;
      next += static_cast<std::uint32_t>(countOf(tile.words[w]));
    }
  return next;
}

std::size_t HitTiles::bytes() const {
  return m_indices.capacity() * sizeof(std::uint32_t) + m_tiles.capacity() * sizeof(Tile);
}

}  // namespace semantic_octree
