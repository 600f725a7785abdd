#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <vector>

namespace semantic_octree {

/** Number of a keyframe, in the order in which they began. */
using KeyframeId = std::size_t;

/** A pose that a keyframe is to have. */
struct KeyframePose {
  KeyframeId keyframe;
  Eigen::Isometry3d T_map_keyframe;
};

/** A map that can be corrected: it remembers the scans that it is made of, keyframe by keyframe. So
 * keyframes can be moved, as a closed loop asks for, and removed.
 *
 * After any sequence of insertions, moves and removals the map is, bit for bit, a new one of the
 * scans that are left. These are inserted in their order, at their present poses and times (see
 * SemanticOcTree::age()). That holds for nodes, class records and G-values, also where log-odds are
 * at their limits or more than three classes were seen. Readers of its changes (MapFollower) are
 * told of corrections as of insertions.
 *
 * How (doc/how-it-works/corrected-maps.md): of each scan its points are kept, and which voxels it
 * saw how, packed tile by tile. A correction follows the beams of the scans that move, and finds
 * the tiles in which one of them now sees something else. Only these tiles are made anew, from what
 * all scans saw in them. */
class KeyframeMap {
 public:
  /** \param map empty; must outlive this, and be changed through this alone (except for its
   * abstraction) \param folder of a file with the scans, which goes when this goes
   * \throw std::invalid_argument the map is not empty
   * \throw std::runtime_error naming the folder: it cannot be written to. */
  explicit KeyframeMap(SemanticOcTree& map, const std::filesystem::path& folder =
                                                std::filesystem::temp_directory_path());
  ~KeyframeMap();
  KeyframeMap(const KeyframeMap&) = delete;
  KeyframeMap& operator=(const KeyframeMap&) = delete;

  /** Begins a keyframe, to which scans belong from now on. */
  KeyframeId begin(const Eigen::Isometry3d& T_map_keyframe);
  /** Inserts a scan into the last keyframe; see SemanticOcTree::insert().
   * \throw std::logic_error there is no keyframe, or the last one was removed
   * \throw std::runtime_error the folder's disk is full; the map is as it was. */
  InsertionReport insert(const LabeledCloud& cloud, const Eigen::Isometry3d& T_keyframe_sensor,
                         const InsertionOptions& options = {}, double secondsSince = 0);

  /** Gives keyframes other poses, all at once: tiles that several of them see are made anew once.
   * If a keyframe has several poses, the last one counts. A failure leaves the map as it was, but
   * not if memory ran out at the end or a tile's file failed (MapFolder): see
   * SemanticOcTree::isBroken().
   * \throw std::out_of_range no such keyframe, or a sensor would be outside of the map. */
  void move(const std::vector<KeyframePose>& poses);
  /** Takes keyframes' scans out of the map, all at once, as if they had never been.
   * \throw std::out_of_range no such keyframe. */
  void remove(const std::set<KeyframeId>& keyframes);

  std::size_t numScans() const;
  /** \throw std::out_of_range no such keyframe. */
  const Eigen::Isometry3d& pose(KeyframeId keyframe) const;

 private:
  class Correction;
  struct Content;
  std::unique_ptr<Content> m;
};

}  // namespace semantic_octree
