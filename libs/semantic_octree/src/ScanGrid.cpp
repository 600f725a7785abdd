#include "ScanGrid.h"

#include <new>
#include <stdexcept>
#include <string>

#include "Lanes.h"

namespace semantic_octree {
namespace {

/** More tiles than fit along the slowest axis, in bits that never overflow. */
constexpr std::size_t kAllTiles = (std::size_t(1) << 14) - 1;
constexpr int kTileSide = 8, kBitsPerTile = 512;

/** Bits 0, 1, 2 of a coordinate moved to Morton positions 0, 3, 6. */
std::uint64_t spread(int v) { return (v & 1) | (v & 2) << 2 | (v & 4) << 4; }

std::size_t powerOfTwo(int atLeast) {
  std::size_t power = 1;
  while (power < static_cast<std::size_t>(atLeast)) power *= 2;
  return power;
}

int floorToTile(int voxel) { return voxel & ~(kTileSide - 1); }

/** One instruction where it is compiled for a processor that has it. */
MSO_INLINE unsigned count(const std::uint64_t* words, unsigned numWords) {
  unsigned bits = 0;
  for (unsigned w = 0; w < numWords; ++w) bits += __builtin_popcountll(words[w]);
  return bits;
}

}  // namespace

void ScanGrid::cover(const VoxelIndex& lowest, const VoxelIndex& highest, std::size_t maxTiles) {
  std::size_t stride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    m_firstVoxel[axis] = floorToTile(lowest[axis] - 1);
    m_firstTile[axis] = (m_firstVoxel[axis] + kKeyOfOrigin) >> 3;
    m_numTiles[axis] = (floorToTile(highest[axis] + 1) - m_firstVoxel[axis]) / kTileSide + 1;
    m_strides[axis] = stride;
    m_offsets[axis].resize(static_cast<std::size_t>(m_numTiles[axis]) * kTileSide);
    for (std::size_t i = 0; i < m_offsets[axis].size(); ++i)
      m_offsets[axis][i] = (i >> 3) * stride * kBitsPerTile + (spread(static_cast<int>(i)) << axis);
    const std::size_t padded = powerOfTwo(m_numTiles[axis]);
    const std::size_t tileBits = axis < 2 ? padded - 1 : kAllTiles;
    m_fields[axis].mask =
        static_cast<std::int64_t>((tileBits * stride * kBitsPerTile) | (spread(7) << axis));
    stride *= padded;
  }
  if (size() > maxTiles)
    throw std::length_error("scan too large to insert: " + std::to_string(size()) +
                            " tiles of 8 x 8 x 8 voxels, max_scan_memory allows " +
                            std::to_string(maxTiles) + "; set max_range");
  reserve(size());
}

void ScanGrid::coverLike(const ScanGrid& o) {
  m_firstVoxel = o.m_firstVoxel;
  m_firstTile = o.m_firstTile;
  m_numTiles = o.m_numTiles;
  m_strides = o.m_strides;
  m_fields = o.m_fields;
  for (int axis = 0; axis < 3; ++axis) m_offsets[axis] = o.m_offsets[axis];
  reserve(size());
}

void ScanGrid::reserve(std::size_t tiles) {
  if (tiles <= m_capacity) return;
  m_capacity = 0;
  m_bits.reset();
  // calloc: pages that no ray touches cost nothing.
  m_bits.reset(static_cast<std::uint64_t*>(std::calloc(tiles * kWords, sizeof(std::uint64_t))));
  if (!m_bits) throw std::bad_alloc();
  m_capacity = tiles;
}

MSO_VECTORIZED unsigned countBits(const std::uint64_t* words, int numWords) {
  return count(words, numWords);
}

MSO_VECTORIZED unsigned countBitsBefore(const std::uint64_t* words, unsigned bit) {
  const std::uint64_t below = (std::uint64_t(1) << (bit & 63)) - 1;
  return count(words, bit >> 6) + __builtin_popcountll(words[bit >> 6] & below);
}

}  // namespace semantic_octree
