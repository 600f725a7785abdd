#pragma once
#include <semantic_octree/store/NodeStore.h>
#include <semantic_octree/store/ScanGrid.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace semantic_octree {

/** Voxels of a scan in which something ended: tiles of bits as in ScanGrid, but only those that
 * have any. Tiles are known by their number (see ScanGrid::numberOf()), voxels by their place. */
class HitTiles {
 public:
  struct Tile {
    VoxelBits words[ScanGrid::kWords];  ///< a block each
    /** Each word's first voxel has this rank among all; the others follow in Morton order. */
    std::uint32_t ranks[ScanGrid::kWords];
  };

  /** Forgets all voxels. */
  void cover(std::size_t numTiles);

  /** Adds a voxel. \return whether it was there before */
  bool testAndSet(const ScanGrid::Place& voxel);
  /** Adds a tile's voxels; it has none yet. */
  void add(std::size_t tile, const VoxelBits* words) {
    m_indices[tile] = static_cast<std::uint32_t>(m_tiles.size());
    std::copy_n(words, ScanGrid::kWords, m_tiles.emplace_back().words);
  }
  /** Ranks voxels. \return their number */
  std::uint32_t rank();

  bool has(std::size_t tile) const { return m_indices[tile] != 0; }
  /** Without bits if nothing ended there. */
  const Tile& tile(std::size_t number) const { return m_tiles[m_indices[number]]; }
  std::uint32_t rankOf(const ScanGrid::Place& voxel) const {
    const Tile& t = tile(voxel.tile);
    const unsigned word = voxel.bit >> 6;
    const VoxelBits below = (VoxelBits(1) << (voxel.bit & 63)) - 1;
    return t.ranks[word] + static_cast<std::uint32_t>(countOf(t.words[word] & below));
  }

  std::size_t bytes() const;

 private:
  std::vector<std::uint32_t> m_indices;  ///< among m_tiles
  std::vector<Tile> m_tiles;             ///< the first one is empty
};

inline bool HitTiles::testAndSet(const ScanGrid::Place& voxel) {
  std::uint32_t& index = m_indices[voxel.tile];
  if (index == 0) {
    index = static_cast<std::uint32_t>(m_tiles.size());
    m_tiles.emplace_back();
  }
  VoxelBits& word = m_tiles[index].words[voxel.bit >> 6];
  const VoxelBits mask = VoxelBits(1) << (voxel.bit & 63);
  const bool before = word & mask;
  word |= mask;
  return before;
}

}  // namespace semantic_octree
