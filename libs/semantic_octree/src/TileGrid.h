#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "ScanBeams.h"

namespace semantic_octree {

/** One bit per voxel of a box of space, in tiles of 8 x 8 x 8 voxels. Inside a tile the bits are in
 * Morton order (x lowest): a 64-bit word is a 4 x 4 x 4 block, a byte the eight children of a node.
 */
class TileGrid {
 public:
  static constexpr int kWords = 8;  ///< per tile

  /** Covers the box of voxels [lowest, highest], and one voxel more on each side. All bits are 0
   * (the user of a bit clears it). \throw std::length_error the box is too large for memory. */
  void cover(const VoxelIndex& lowest, const VoxelIndex& highest);
  /** Covers the same box as another grid. */
  void coverLike(const TileGrid& o);

  /** First tile, in tiles (voxel / 8) of the map whose lowest voxel is 0 (OctoMap's keys). */
  const VoxelIndex& firstTile() const { return m_firstTile; }
  const VoxelIndex& numTiles() const { return m_numTiles; }
  std::size_t size() const { return m_size; }
  std::uint64_t* tile(std::size_t i) { return m_bits.get() + i * kWords; }
  const std::uint64_t* tile(std::size_t i) const { return m_bits.get() + i * kWords; }

  /** Position of a bit = sum of three table entries at the voxel's coordinates relative to the
   * grid. */
  const std::uint64_t* xOffsets() const { return m_offsets[0].data(); }
  const std::uint64_t* yOffsets() const { return m_offsets[1].data(); }
  const std::uint64_t* zOffsets() const { return m_offsets[2].data(); }
  /** What to subtract from voxel units of the map to get coordinates relative to the grid. */
  Eigen::Array3d origin() const { return m_firstVoxel.cast<double>(); }

  std::uint64_t bitOf(const VoxelIndex& relative) const {
    return m_offsets[0][relative.x()] + m_offsets[1][relative.y()] + m_offsets[2][relative.z()];
  }
  /** Sets a bit. \return whether it was set before */
  bool testAndSet(std::uint64_t bit) {
    std::uint64_t& word = m_bits[bit >> 6];
    const std::uint64_t mask = std::uint64_t(1) << (bit & 63);
    const bool before = word & mask;
    word |= mask;
    return before;
  }
  std::uint64_t* words() { return m_bits.get(); }
  std::size_t bytes() const { return m_capacity * kWords * sizeof(std::uint64_t); }

 private:
  struct Free {
    void operator()(std::uint64_t* p) const { std::free(p); }
  };
  void reserve(std::size_t tiles);

  VoxelIndex m_firstVoxel, m_firstTile, m_numTiles;
  std::size_t m_size = 0, m_capacity = 0;
  std::unique_ptr<std::uint64_t[], Free> m_bits;
  std::vector<std::uint64_t> m_offsets[3];
};

}  // namespace semantic_octree
