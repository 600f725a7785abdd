#pragma once
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/SemanticOcTreeNode.h>
#include <semantic_octree/store/ChangeLog.h>
#include <semantic_octree/store/TileCodes.h>

namespace semantic_octree {

/** The cubes in which a map changed, each a tile of 8 x 8 x 8 voxels or larger. */
class TileLog : public ChangeLog<std::uint64_t> {
 public:
  void add(const Cell& cube);
};

/** Tiles in cubes, or in a map. */
class TileList {
 public:
  /** Those in a cube of a TileLog. */
  void add(std::uint64_t cube);
  /** Those that a node's leaves are in. */
  void add(const SemanticOcTreeNode& node, const Cell& cell);
  /** Each once, sorted. */
  std::vector<octomap::OcTreeKey> keys();

 private:
  void addAll(const Cell& cube);
  std::vector<std::uint64_t> m_tiles;
};

}  // namespace semantic_octree
