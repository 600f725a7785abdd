#include <semantic_octree/store/TileLog.h>

#include <algorithm>

namespace semantic_octree {
namespace {

constexpr int kDepthAt = 48;  // its bits, above those of the three indices

std::uint64_t pack(const Cell& cube) {
  const auto bits = [](int number, int at) { return static_cast<std::uint64_t>(number) << at; };
  return bits(cube.depth, kDepthAt) | bits(cube.index.z(), 32) | bits(cube.index.y(), 16) |
         bits(cube.index.x(), 0);
}

int index(std::uint64_t packed, int at) { return static_cast<int>(packed >> at & 0xffff); }

octomap::OcTreeKey lowestKey(std::uint64_t packed) {
  const auto key = [packed](int at) {
    return static_cast<octomap::key_type>(index(packed, at) * edgeAtDepth(kTileDepth));
  };
  return octomap::OcTreeKey(key(0), key(16), key(32));
}

}  // namespace

void TileLog::add(const Cell& cube) { push(pack(cube)); }

void TileList::add(std::uint64_t cube) {
  addAll({VoxelIndex(index(cube, 0), index(cube, 16), index(cube, 32)), index(cube, kDepthAt)});
}

void TileList::add(const SemanticOcTreeNode& node, const Cell& cell) {
  if (node.isLeaf() || cell.depth == kTileDepth) return addAll(cell);
  for (int i = 0; i < 8; ++i)
    if (const SemanticOcTreeNode child = node.child(i)) add(child, cell.child(i));
}

void TileList::addAll(const Cell& cube) {
  if (cube.depth == kTileDepth) return m_tiles.push_back(pack(cube));
  for (int i = 0; i < 8; ++i) addAll(cube.child(i));
}

std::vector<octomap::OcTreeKey> TileList::keys() {
  std::sort(m_tiles.begin(), m_tiles.end());
  m_tiles.erase(std::unique(m_tiles.begin(), m_tiles.end()), m_tiles.end());
  std::vector<octomap::OcTreeKey> keys(m_tiles.size());
  std::transform(m_tiles.begin(), m_tiles.end(), keys.begin(), lowestKey);
  return keys;
}

}  // namespace semantic_octree
