#include <semantic_octree/store/TouchedTiles.h>

#include <algorithm>

namespace semantic_octree {
namespace {

std::uint64_t pack(const VoxelIndex& tile) {
  return static_cast<std::uint64_t>(tile.z()) << 32 | static_cast<std::uint64_t>(tile.y()) << 16 |
         static_cast<std::uint64_t>(tile.x());
}

octomap::OcTreeKey lowestKey(std::uint64_t packed) {
  const auto key = [packed](int shift) {
    return static_cast<octomap::key_type>((packed >> shift & 0xffff) * 8);
  };
  return octomap::OcTreeKey(key(0), key(16), key(32));
}

}  // namespace

void TouchedTiles::add(const Cell& cube) {
  if (cube.depth == kDepth) {
    m_tiles.insert(pack(cube.index));
    return;
  }
  for (int i = 0; i < 8; ++i) add(cube.child(i));
}

std::vector<octomap::OcTreeKey> TouchedTiles::take() {
  std::vector<std::uint64_t> sorted(m_tiles.begin(), m_tiles.end());
  std::sort(sorted.begin(), sorted.end());
  std::vector<octomap::OcTreeKey> keys(sorted.size());
  m_tiles.clear();
  std::transform(sorted.begin(), sorted.end(), keys.begin(), lowestKey);
  return keys;
}

}  // namespace semantic_octree
