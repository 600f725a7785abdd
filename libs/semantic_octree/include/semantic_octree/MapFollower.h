#pragma once
#include <semantic_octree/Keys.h>

#include <memory>
#include <vector>

namespace semantic_octree {

class SemanticOcTree;

/** Tiles of 8 x 8 x 8 voxels that changed. */
struct TileChange {
  /** `tiles` are all that are known in part. What the reader knew before does not count. */
  bool all = false;
  std::vector<octomap::OcTreeKey> tiles;  ///< lowest key of each, multiples of 8, sorted
};

/** A reader of what changes in a map: SemanticOcTree::follow() makes one.
 *
 *     MapFollower follower = map.follow();
 *     map.insert(...);
 *     for (const auto& tile : follower.tiles().tiles) ...  // since the last call
 *
 * A map has any number of readers, and none sees less because of another. Insertions, aging, and
 * corrections (KeyframeMap) are told as what changed. A reader is told everything, with `all` set:
 * at its first look, after clear(), and after the map took another's content (assignment, swap, a
 * folder, filling). So is one that fell behind: a map keeps at most 2^20 changes, 8 bytes each, and
 * none before anybody looked.
 *
 * A reader follows the object, wherever its content comes from; copies of a map have no readers.
 * Not thread safe: the map must not change during a call. \throw std::logic_error in all functions:
 * the map is gone, or broken (SemanticOcTree::isBroken()). */
class MapFollower {
 public:
  ~MapFollower();
  MapFollower(MapFollower&&) noexcept;
  MapFollower& operator=(MapFollower&&) noexcept;

  /** Tiles that changed since the last call; some may be what they were. */
  TileChange tiles();
  /** For who knows the map as it is: what changed until now is not told, and no node visited. */
  void skipTiles();

 private:
  friend class SemanticOcTree;
  struct Content;
  explicit MapFollower(std::unique_ptr<Content> content);
  std::unique_ptr<Content> m;
};

}  // namespace semantic_octree
