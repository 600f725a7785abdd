#pragma once
#include <semantic_octree/ClassFilter.h>
#include <semantic_octree/store/HitVotes.h>
#include <semantic_octree/store/NodeStore.h>

namespace semantic_octree {

/** What a scan says of a block's voxels. */
struct BlockScan {
  VoxelBits free, hit;  ///< no voxel is both
  const HitVotes& votes;
  std::uint32_t firstHit;  ///< rank of the first hit voxel; the others follow in Morton order

  VoxelBits touched() const { return free | hit; }
};

/** The class filter, applied to a block of voxels at once. */
class BlockUpdate {
 public:
  BlockUpdate(NodeStore& store, NodeArena& arena, const ClassFilter<float>& filter, bool pruning);

  /** A leaf without children that was seen free as a whole. \return whether it changed */
  bool miss(Slot& leaf);
  /** The value that further misses leave as it is. */
  Units lowest() const { return m_lowest; }

  struct Result {
    bool changed;   ///< anything
    bool reshaped;  ///< which voxels are known, or which octants are leaves
  };
  Result update(Block& block, const BlockScan& scan);

 private:
  /** Octants that are leaves with a record, and are not seen free as a whole, get a record for each
   * voxel; voxels that are hit with a label get one. */
  void makeRoomForRecords(Block& block, const BlockScan& scan);
  void hit(Block& block, const BlockScan& scan);
  void hitVoxel(Block& block, int voxel, bool isNew, std::uint32_t rank, const HitVotes& votes);
  void missRecords(Block& block, VoxelBits free);
  /** \return the occupancy; `isCertain`: the record says no more than that */
  Units missRecord(ClassRecord& record, bool& isCertain) const;
  void mergeOctants(Block& block, VoxelBits touched);
  bool voxelsAgree(const Block& block, int octant) const;

  NodeStore& m_store;
  NodeArena& m_arena;
  const ClassFilter<float>& m_filter;
  bool m_pruning;
  Units m_miss, m_lowest, m_highest;
  /** Of the block at work. */
  bool m_recordsChanged = false;
  VoxelBits m_superfluous = 0;  ///< records to be dropped
  VoxelBits m_fresh = 0;        ///< voxels whose record is not set yet
};

}  // namespace semantic_octree
