#include <semantic_octree/store/FusionRule.h>
#include <semantic_octree/store/Lanes.h>

#include <algorithm>

namespace semantic_octree {

MSO_VECTORIZED Block::Count Block::count() const {
  const std::uint8_t any = octantsWith(known);
  // The leaves' bits, one in each octant, then all of its.
  VoxelBits leaves = leafOctants * VoxelBits(0x0101010101010101) & 0x8040201008040201;
  leaves = ((leaves + 0x7f7f7f7f7f7f7f7f) >> 7 & 0x0101010101010101) * 0xff;
  return {countOf(any) + countOf(known & ~leaves),
          countOf(static_cast<std::uint8_t>(any & ~leafOctants))};
}

namespace {

constexpr int kLanesOfUnits = 16;
using UnitVector = Units __attribute__((vector_size(32)));

MSO_INLINE UnitVector ofAll(Units value) { return UnitVector{} + value; }

/** The nearest that 16 bits hold. */
Units nearest(int units) {
  return static_cast<Units>(std::min<int>(INT16_MAX, std::max<int>(-INT16_MAX, units)));
}

/** Whether eight values are the same. */
bool eightEqual(const Units* values) {
  std::uint64_t low, high;
  std::memcpy(&low, values, sizeof low);
  std::memcpy(&high, values + 4, sizeof high);
  return low == high && low == (low << 16 | low >> 48);
}

/** What is added to log-odds, and their limits. */
struct UnitIncrement {
  Units increment, lowest, highest;
};

/** Adds to those of 64 values whose bits are set, and puts them into the limits; what is unknown
 * counts as 0. */
MSO_VECTORIZED void missWhere(Units* values, std::uint64_t where, const UnitIncrement& by) {
  UnitVector bitOfLane;
  for (int i = 0; i < kLanesOfUnits; ++i) bitOfLane[i] = static_cast<Units>(1u << i);
  // Limits are kept before adding, so that nothing overflows.
  const UnitVector low = ofAll(nearest(by.lowest - by.increment)),
                   high = ofAll(nearest(by.highest - by.increment)), unknown = ofAll(kUnknown),
                   zero = {};
  for (int i = 0; i < 64; i += kLanesOfUnits, where >>= kLanesOfUnits) {
    UnitVector old;
    std::memcpy(&old, values + i, sizeof old);
    UnitVector sum = old == unknown ? zero : old;
    sum = sum < low ? low : sum;
    sum = sum > high ? high : sum;
    sum += by.increment;
    const UnitVector bits = ofAll(static_cast<Units>(where)) & bitOfLane;
    const UnitVector result = bits == zero ? old : sum;
    std::memcpy(values + i, &result, sizeof result);
  }
}

/** The class filter, applied to a block of voxels at once. */
class BlockUpdate final : public BlockFusion {
 public:
  BlockUpdate(NodeStore& store, NodeArena& arena, ClassFilter filter, bool pruning)
      : m_store(store),
        m_arena(arena),
        m_filter(std::move(filter)),
        m_pruning(pruning),
        m_miss(toUnits(m_filter.missIncrement())),
        m_lowest(toUnits(m_filter.lowestOccupancy())),
        m_highest(toUnits(m_filter.highestOccupancy())) {}

  bool miss(Slot& leaf) override {
    const Slot before = leaf;
    if (leaf.kind != Slot::Kind::LeafWithRecord) {
      leaf.value = toUnits(m_filter.occupancyAfterMiss(fromUnits(leaf.value)));
      return leaf.value != before.value;
    }
    bool isCertain = false;
    ClassRecord& record = m_store.record(leaf);
    const ClassRecord recordBefore = record;
    leaf.value = missRecord(record, isCertain);
    const bool changed = leaf.value != before.value || record != recordBefore || isCertain;
    if (isCertain) m_arena.dropRecord(leaf);
    return changed;
  }

  Units lowest() const override { return m_lowest; }

  Result update(Block& block, const BlockScan& scan) override {
    const Block before = block;
    m_recordsChanged = false;
    m_superfluous = m_fresh = 0;
    const VoxelBits touched = scan.touched();
    makeRoomForRecords(block, scan);
    missWhere(block.values, scan.free, {m_miss, m_lowest, m_highest});
    block.known |= touched;
    if (scan.hit) hit(block, scan);
    if (block.recorded & scan.free) missRecords(block, scan.free);
    if (m_pruning) mergeOctants(block, touched);
    m_arena.setRecorded(block, block.recorded & ~m_superfluous);
    const bool reshaped = block.known != before.known || block.leafOctants != before.leafOctants;
    if (reshaped) m_arena.recount(before.count(), block.count());
    const bool changed = reshaped || m_recordsChanged || block.recorded != before.recorded ||
                         !std::equal(before.values, before.values + 64, block.values);
    return {changed, reshaped};
  }

 private:
  /** Octants that are leaves with a record, and are not seen free as a whole, get a record for each
   * voxel. So do voxels that are hit with a label. */
  void makeRoomForRecords(Block& block, const BlockScan& scan) {
    if (!scan.hit && !block.leafOctants) return;
    VoxelBits room = block.recorded, opened = 0;
    unsigned octants = block.leafOctants & octantsWith(scan.touched()) & octantsWith(~scan.free);
    block.leafOctants &= static_cast<std::uint8_t>(~octants);
    for (; octants; octants &= octants - 1) {
      const int o = __builtin_ctz(octants);
      if (block.hasRecord(8 * o)) opened |= VoxelBits(0xff) << 8 * o;
    }
    room |= opened;
    std::uint32_t rank = scan.firstHit;
    for (VoxelBits bits = scan.hit; bits; bits &= bits - 1, ++rank)
      if (scan.votes.softLabelOf(rank) || scan.votes.hasVotes(rank)) room |= bits & -bits;
    if (room == block.recorded) return;
    m_fresh = room & ~block.recorded & ~opened;
    m_arena.setRecorded(block, room);
    for (; opened; opened &= opened - 1) {
      const int voxel = __builtin_ctzll(opened);
      if (voxel % 8 != 0) m_store.record(block, voxel) = m_store.record(block, voxel & ~7);
    }
  }

  void hit(Block& block, const BlockScan& scan) {
    std::uint32_t rank = scan.firstHit;
    for (VoxelBits bits = scan.hit; bits; bits &= bits - 1, ++rank)
      hitVoxel(block, __builtin_ctzll(bits), m_fresh & bits & -bits, rank, scan.votes);
  }

  void hitVoxel(Block& block, int voxel, bool isNew, std::uint32_t rank, const HitVotes& votes) {
    Units& value = block.values[voxel];
    const float before = value == kUnknown ? 0.f : fromUnits(value);
    if (!(block.recorded & (VoxelBits(1) << voxel))) {
      value = toUnits(m_filter.occupancyAfterUnlabeledHit(before));
      return;
    }
    ClassRecord& record = m_store.record(block, voxel);
    Belief belief = isNew ? m_filter.uniform(before) : record.belief();
    if (const float* soft = votes.softLabelOf(rank)) {
      m_filter.hit(belief, soft);
    } else if (votes.hasVotes(rank)) {
      const HitVotes::Result hard = votes.votesOf(rank);
      m_filter.hit(belief, hard.votes.data(), hard.numVoted);
    } else {
      m_filter.hit(belief);
    }
    const ClassRecord after = ClassRecord::of(belief);
    if (!isNew && after == record) return;
    m_recordsChanged = true;
    record = after;
    value = toUnits(m_filter.occupancyOf(belief));
  }

  void missRecords(Block& block, VoxelBits free) {
    ClassRecord* const records = m_store.recordsOf(block);
    for (VoxelBits bits = block.recorded & free; bits; bits &= bits - 1) {
      const int voxel = __builtin_ctzll(bits);
      bool isCertain = false;
      ClassRecord& record = records[block.rankOfRecord(voxel)];
      const ClassRecord before = record;
      const Units value = missRecord(record, isCertain);
      std::fill_n(block.values + voxel, block.isLeafOctant(voxel / 8) ? 8 : 1, value);
      if (isCertain) m_superfluous |= (VoxelBits(1) << voxel);
      m_recordsChanged |= record != before;
    }
  }

  /** \return the occupancy; `isCertain`: the record says no more than that */
  Units missRecord(ClassRecord& record, bool& isCertain) const {
    Belief belief = record.belief();
    m_filter.miss(belief);
    record = ClassRecord::of(belief);
    const float uniform = m_filter.occupancyOfUniform(belief.rest);
    isCertain = belief.isUniform() && uniform <= m_filter.lowestOccupancy();
    return toUnits(isCertain ? uniform : m_filter.occupancyOf(belief));
  }

  void mergeOctants(Block& block, VoxelBits touched) {
    unsigned octants = octantsWith(touched) & ~(block.leafOctants | octantsWith(~block.known));
    for (; octants; octants &= octants - 1) {
      const int o = __builtin_ctz(octants);
      if (!voxelsAgree(block, o)) continue;
      m_superfluous |= VoxelBits(0xfe) << 8 * o;  // the first voxel's record is that of all
      block.leafOctants |= static_cast<std::uint8_t>(1u << o);
    }
  }

  bool voxelsAgree(const Block& block, int octant) const {
    const int first = 8 * octant;
    if (!eightEqual(block.values + first)) return false;
    const std::uint8_t recorded = octantOf(block.recorded & ~m_superfluous, octant);
    if (recorded == 0) return true;
    if (recorded != 0xff) return false;
    const ClassRecord* records = &m_store.record(block, first);
    return std::all_of(records + 1, records + 8,
                       [&](const ClassRecord& r) { return r == records[0]; });
  }

  NodeStore& m_store;
  NodeArena& m_arena;
  ClassFilter m_filter;
  bool m_pruning;
  Units m_miss, m_lowest, m_highest;
  /** Whether records of the block at work changed. */
  bool m_recordsChanged = false;
  VoxelBits m_superfluous = 0;  ///< records to be dropped
  VoxelBits m_fresh = 0;        ///< voxels whose record is not set yet
};

}  // namespace

std::unique_ptr<BlockFusion> fusionBy(ClassFilter filter, NodeStore& store, NodeArena& arena,
                                      bool pruning) {
  return std::make_unique<BlockUpdate>(store, arena, std::move(filter), pruning);
}

}  // namespace semantic_octree
