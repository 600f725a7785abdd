#pragma once
#include <semantic_octree/Keys.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace semantic_octree {

class SemanticOcTree;
struct TreeChange;

/** Tiles of 8 x 8 x 8 voxels that changed. */
struct TileChange {
  /** These are all tiles that are known in part. What the reader knew before does not count. */
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
 * at its first look, after clear(), after the map took another one's content (assignment, swap, a
 * folder, a map that was filled), and after it has fallen behind: a map keeps at most
 * 2^20 changes of tiles and of leaves, 8 bytes each. Tiles and leaves have places of their own, and
 * nothing is kept of what nobody has looked at yet.
 *
 * It follows the object, wherever its content comes from; copies of a map have no readers. Not
 * thread safe: the map must not change during a call.
 * \throw std::logic_error in all functions: the map is gone, or broken
 * (SemanticOcTree::isBroken()).
 */
class MapFollower {
 public:
  ~MapFollower();
  MapFollower(MapFollower&&) noexcept;
  MapFollower& operator=(MapFollower&&) noexcept;

  /** Tiles that changed since the last call; some may be what they were. */
  TileChange tiles();
  /** Leaves of the compressed tree that came and went since the last call, in time proportional to
   * the nodes that changed (see Abstraction). A new abstraction is told as everything.
   * \throw std::logic_error the map keeps no G-values. */
  TreeChange leaves();
  /** As tiles(), for who knows the map as it is: nothing is told, and none of its nodes visited. */
  void skipTiles();
  /** As leaves(), without a list of what may be all of a map. \return number of leaves() of the
   * compressed tree now */
  std::size_t skipLeaves();

 private:
  friend class SemanticOcTree;
  class Places;
  explicit MapFollower(std::unique_ptr<Places> places);
  std::unique_ptr<Places> m_places;
};

}  // namespace semantic_octree
