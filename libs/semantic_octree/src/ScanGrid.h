#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "ScanBeams.h"

namespace semantic_octree {

/** One bit per voxel of a box of space, in tiles of 8 x 8 x 8 voxels. Inside a tile the bits are in
 * Morton order (x lowest): a 64-bit word is a 4 x 4 x 4 block, a byte the eight children of a node.
 * Rows and layers of tiles are padded to powers of two, so that each coordinate of a voxel has bits
 * of its own in the position of the voxel's bit. */
class ScanGrid {
 public:
  static constexpr int kWords = 8;  ///< per tile

  /** Covers the box of voxels [lowest, highest], and one voxel more on each side. All bits are 0
   * (the user of a bit clears it). \param maxTiles more are refused
   * \throw std::length_error the box is too large. */
  void cover(const VoxelIndex& lowest, const VoxelIndex& highest, std::size_t maxTiles);
  /** Covers the same box as another grid. */
  void coverLike(const ScanGrid& o);

  /** Bits of a position that belong to one coordinate. */
  struct Field {
    std::int64_t mask;
    /** What to add to the coordinate's part, which is then masked, to get the next or the previous
     * voxel's: carries run through the bits between. */
    std::int64_t up() const { return -mask; }
    std::int64_t down() const { return -(mask & -mask); }
  };
  const Field& field(int axis) const { return m_fields[axis]; }

  /** First tile, in tiles (voxel / 8) of the map whose lowest voxel is 0 (OctoMap's keys). */
  const VoxelIndex& firstTile() const { return m_firstTile; }
  const VoxelIndex& numTiles() const { return m_numTiles; }
  /** Tiles with padding: one above the largest index. */
  std::size_t size() const { return m_strides[2] * m_numTiles.z(); }
  /** Distance of neighbors' indices. */
  std::size_t stride(int axis) const { return m_strides[axis]; }
  /** Calls f(index) for every tile that is not padding. */
  template <typename F>
  void forEachTile(const F& f) const {
    for (int z = 0; z < m_numTiles.z(); ++z)
      for (int y = 0; y < m_numTiles.y(); ++y)
        for (int x = 0; x < m_numTiles.x(); ++x) f(z * m_strides[2] + y * m_strides[1] + x);
  }
  std::uint64_t* tile(std::size_t i) { return m_bits.get() + i * kWords; }
  const std::uint64_t* tile(std::size_t i) const { return m_bits.get() + i * kWords; }

  /** Position of a bit = sum of three table entries at the voxel's coordinates relative to the
   * grid. */
  const std::uint64_t* offsets(int axis) const { return m_offsets[axis].data(); }
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
  std::array<std::size_t, 3> m_strides{};
  std::array<Field, 3> m_fields{};
  std::size_t m_capacity = 0;
  std::unique_ptr<std::uint64_t[], Free> m_bits;
  std::vector<std::uint64_t> m_offsets[3];
};

/** Bits set in some words. */
unsigned countBits(const std::uint64_t* words, int numWords);

/** Bits set in front of a bit. */
unsigned countBitsBefore(const std::uint64_t* words, unsigned bit);

}  // namespace semantic_octree
