#pragma once
#include <semantic_octree/store/ScanGrid.h>

#include <cstdint>
#include <vector>

namespace semantic_octree {

/** What a cube of space holds of a scan. */
struct CubeContent {
  static constexpr std::uint8_t kAny = 1, kHit = 2, kNotAllFree = 4;
  std::uint8_t flags = 0;
  bool any() const { return flags & kAny; }
  bool hit() const { return flags & kHit; }
  /** Every voxel was seen free, none was hit. */
  bool allFree() const { return flags == kAny; }
  /** Joins what a part of the cube holds. */
  void add(CubeContent part) { flags |= part.any() ? part.flags : kNotAllFree; }
};

/** Summary of a scan's tiles at every level of the tree above them: level 0 are the tiles, a cube
 * of level l has a side of 8 * 2^l voxels, level 13 is the whole map. */
class ScanPyramid {
 public:
  static constexpr int kTopLevel = 13;

  /** Starts anew for the tiles of this grid: nothing seen. */
  void cover(const ScanGrid& grid);
  /** \param tile its number in the grid */
  void set(std::size_t tile, CubeContent content) { m_levels[0].cubes[tile] = content; }
  CubeContent tile(std::size_t tile) const { return m_levels[0].cubes[tile]; }
  /** Fills the levels above the tiles. */
  void build();

  /** Cube at absolute coordinates (key / (8 * 2^level)); nothing outside the grid. */
  CubeContent at(int level, const VoxelIndex& cube) const {
    const Level& l = m_levels[level];
    const VoxelIndex i = cube - l.first;
    if ((i < 0).any() || (i >= l.size).any()) return {};
    return l.cubes[l.indexOf(i)];
  }
  std::size_t bytes() const;

 private:
  struct Level {
    VoxelIndex first, size;
    std::vector<CubeContent> cubes;
    std::size_t indexOf(const VoxelIndex& i) const {
      return (std::size_t(i.z()) * size.y() + i.y()) * size.x() + i.x();
    }
  };
  void buildLevel(int level);

  Level m_levels[kTopLevel + 1];
};

}  // namespace semantic_octree
