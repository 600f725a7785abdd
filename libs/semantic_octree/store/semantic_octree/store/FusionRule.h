#pragma once
#include <semantic_octree/store/HitVotes.h>
#include <semantic_octree/store/NodeStore.h>

#include <memory>

namespace semantic_octree {

/** What a scan says of a block's voxels. */
struct BlockScan {
  VoxelBits free, hit;  ///< no voxel is both
  const HitVotes& votes;
  std::uint32_t firstHit;  ///< rank of the first hit voxel; the others follow in Morton order

  VoxelBits touched() const { return free | hit; }
};

/** Puts what a scan says into nodes, in one thread. */
class BlockFusion {
 public:
  virtual ~BlockFusion() = default;
  /** A leaf without children that was seen free as a whole. \return whether it changed */
  virtual bool miss(Slot& leaf) = 0;
  /** A leaf without a class record, of this value or below, stays what it is in further misses. */
  virtual Units lowest() const = 0;

  struct Result {
    bool changed;   ///< anything
    bool reshaped;  ///< which voxels are known, or which octants are leaves
  };
  virtual Result update(Block& block, const BlockScan& scan) = 0;
};

/** Fusion by the class filter. */
std::unique_ptr<BlockFusion> fusionBy(ClassFilter filter, NodeStore& store, NodeArena& arena,
                                      bool pruning);

/** What observations make of voxels. What a voxel is, is for all rules the same: log-odds of its
 * occupancy, and a class record where labels were seen. */
class FusionRule {
 public:
  virtual ~FusionRule() = default;
  /** One thread's part of a scan; the rule must outlive it. \param pruning octants whose voxels
   * agree become leaves \param labels how far the scan's are trusted */
  virtual std::unique_ptr<BlockFusion> begin(NodeStore& store, NodeArena& arena, bool pruning,
                                             const LabelReliability& labels) const = 0;
};

}  // namespace semantic_octree
