#pragma once
#include <semantic_octree/store/Cubes.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace semantic_octree {

/** Tiles of 8 x 8 x 8 voxels, the nodes at depth 13, known by their Morton codes (x lowest): all
 * tiles below a node follow each other. */
constexpr int kTileDepth = 13;

/** Ascending, each once. */
using TileCodes = std::vector<std::uint64_t>;

/** \param tile key of a voxel in it / 8 */
inline std::uint64_t tileCode(const VoxelIndex& tile) {
  const auto spread = [](int coordinate) {
    auto bits = static_cast<std::uint64_t>(coordinate);
    bits = (bits | bits << 16) & 0x0000ff0000ff;
    bits = (bits | bits << 8) & 0x00f00f00f00f;
    bits = (bits | bits << 4) & 0x0c30c30c30c3;
    return (bits | bits << 2) & 0x249249249249;
  };
  return spread(tile.x()) | spread(tile.y()) << 1 | spread(tile.z()) << 2;
}

inline VoxelIndex tileOf(std::uint64_t code) {
  const auto collect = [](std::uint64_t bits) {
    bits &= 0x249249249249;
    bits = (bits | bits >> 2) & 0x0c30c30c30c3;
    bits = (bits | bits >> 4) & 0x00f00f00f00f;
    bits = (bits | bits >> 8) & 0x0000ff0000ff;
    return static_cast<int>((bits | bits >> 16) & 0xffff);
  };
  return {collect(code), collect(code >> 1), collect(code >> 2)};
}

/** The box around some tiles. */
class TileBox {
 public:
  TileBox() = default;
  explicit TileBox(const TileCodes& tiles) {
    for (const std::uint64_t code : tiles) add(tileOf(code));
  }

  void add(const VoxelIndex& tile) {
    m_lowest = m_lowest.min(tile);
    m_highest = m_highest.max(tile);
  }
  bool empty() const { return (m_highest < m_lowest).any(); }
  /** An empty one meets none. */
  bool meets(const TileBox& o) const {
    return (m_lowest <= o.m_highest).all() && (o.m_lowest <= m_highest).all();
  }
  const VoxelIndex& lowest() const { return m_lowest; }
  const VoxelIndex& highest() const { return m_highest; }

 private:
  VoxelIndex m_lowest = VoxelIndex::Constant(kNumKeys), m_highest = -m_lowest;
};

/** The codes of those tiles that lie below a node. */
struct TileRange {
  TileCodes::const_iterator first, last;

  bool empty() const { return first == last; }
  /** Below the i-th child of a node at a depth. */
  TileRange below(int depth, int i) const {
    const int shift = 3 * (kTileDepth - depth - 1);
    const auto childOf = [shift](std::uint64_t code) {
      return static_cast<int>(code >> shift & 7);
    };
    return {std::partition_point(first, last, [&](std::uint64_t c) { return childOf(c) < i; }),
            std::partition_point(first, last, [&](std::uint64_t c) { return childOf(c) <= i; })};
  }
};

}  // namespace semantic_octree
