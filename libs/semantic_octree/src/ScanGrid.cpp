#include <semantic_octree/store/Lanes.h>
#include <semantic_octree/store/ScanGrid.h>

#include <new>
#include <stdexcept>
#include <string>

namespace semantic_octree {
namespace {

constexpr int kTileSide = 8, kBitsPerTile = 512, kTilesPerPage = 64;
/** More pages than fit along the slowest axis, in bits that never overflow. */
constexpr std::size_t kAllPages = (std::size_t(1) << 12) - 1;

/** Bits 0, 1, 2 of a coordinate moved to Morton positions 0, 3, 6. */
std::uint64_t spread(int v) { return (v & 1) | (v & 2) << 2 | (v & 4) << 4; }

std::size_t powerOfTwo(std::size_t atLeast) {
  std::size_t power = 1;
  while (power < atLeast) power *= 2;
  return power;
}

int floorToTile(int voxel) { return voxel & ~(kTileSide - 1); }

}  // namespace

void ScanGrid::cover(const VoxelIndex& lowest, const VoxelIndex& highest, std::size_t maxTiles) {
  std::size_t stride = 1;  // of pages
  for (int axis = 0; axis < 3; ++axis) {
    m_firstVoxel[axis] = floorToTile(lowest[axis] - 1);
    m_firstTile[axis] = (m_firstVoxel[axis] + kKeyOfOrigin) >> 3;
    m_numTiles[axis] = (floorToTile(highest[axis] + 1) - m_firstVoxel[axis]) / kTileSide + 1;
    const auto position = [&](std::size_t page, int tile, int voxel) {
      const std::uint64_t tiles = page * stride * kTilesPerPage + (tile << 2 * axis);
      return tiles * kBitsPerTile + (spread(voxel) << axis);
    };
    m_offsets[axis].resize(static_cast<std::size_t>(m_numTiles[axis]) * kTileSide);
    for (std::size_t i = 0; i < m_offsets[axis].size(); ++i)
      m_offsets[axis][i] = position(i >> 5, i >> 3 & 3, static_cast<int>(i & 7));
    const std::size_t pages = (m_numTiles[axis] + 3) / 4, padded = powerOfTwo(pages);
    m_fields[axis].mask =
        static_cast<std::int64_t>(position(axis < 2 ? padded - 1 : kAllPages, 3, 7));
    stride *= axis < 2 ? padded : pages;
  }
  m_numPages = stride;
  if (m_numPages * kTilesPerPage > maxTiles)
    throw std::length_error(
        "scan too large to insert: " + std::to_string(m_numPages * kTilesPerPage) +
        " tiles of 8 x 8 x 8 voxels, where memory allows " + std::to_string(maxTiles) +
        "; set max_range");
  reserve();
}

void ScanGrid::coverLike(const ScanGrid& o) {
  m_firstVoxel = o.m_firstVoxel;
  m_firstTile = o.m_firstTile;
  m_numTiles = o.m_numTiles;
  m_fields = o.m_fields;
  for (int axis = 0; axis < 3; ++axis) m_offsets[axis] = o.m_offsets[axis];
  m_numPages = o.m_numPages;
  reserve();
}

void ScanGrid::reserve() {
  if (m_numPages <= m_capacity) return;
  m_capacity = 0;
  m_memory.reset();
  // calloc: pages that no ray touches cost nothing.
  std::size_t bytes = (m_numPages + 1) * kBytesPerPage;
  m_memory.reset(static_cast<std::byte*>(std::calloc(bytes, 1)));
  if (!m_memory) throw std::bad_alloc();
  void* first = m_memory.get();
  std::align(kBytesPerPage, m_numPages * kBytesPerPage, first, bytes);
  m_words = static_cast<std::uint64_t*>(first);
  m_capacity = m_numPages;
}

MSO_VECTORIZED unsigned countBits(const std::uint64_t* words, int numWords) {
  unsigned bits = 0;  // one instruction a word where it is compiled for a processor that has it
  for (int w = 0; w < numWords; ++w) bits += __builtin_popcountll(words[w]);
  return bits;
}

}  // namespace semantic_octree
