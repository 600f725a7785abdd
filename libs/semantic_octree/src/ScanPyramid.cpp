#include <semantic_octree/store/ScanPyramid.h>

namespace semantic_octree {

void ScanPyramid::cover(const ScanGrid& grid) {
  const VoxelIndex last = grid.firstTile() + grid.numTiles() - 1;
  for (int level = 0; level <= kTopLevel; ++level) {
    Level& l = m_levels[level];
    for (int axis = 0; axis < 3; ++axis) {
      l.first[axis] = grid.firstTile()[axis] >> level;
      l.size[axis] = (last[axis] >> level) - l.first[axis] + 1;
    }
    l.cubes.assign(l.indexOf(l.size - 1) + 1, CubeContent());
  }
}

void ScanPyramid::build() {
  for (int level = 1; level <= kTopLevel; ++level) buildLevel(level);
}

void ScanPyramid::buildLevel(int level) {
  Level& l = m_levels[level];
  VoxelIndex i;
  for (i.z() = 0; i.z() < l.size.z(); ++i.z())
    for (i.y() = 0; i.y() < l.size.y(); ++i.y())
      for (i.x() = 0; i.x() < l.size.x(); ++i.x()) {
        CubeContent& content = l.cubes[l.indexOf(i)];
        for (int child = 0; child < 8; ++child) {
          const CubeContent part =
              at(level - 1, (l.first + i) * 2 + VoxelIndex(child & 1, child >> 1 & 1, child >> 2));
          content.add(part);
        }
      }
}

std::size_t ScanPyramid::bytes() const {
  std::size_t bytes = 0;
  for (const Level& level : m_levels) bytes += level.cubes.capacity();
  return bytes;
}

}  // namespace semantic_octree
