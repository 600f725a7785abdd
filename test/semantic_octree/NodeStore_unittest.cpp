// Nodes, class records and what is merged.
#include <gtest/gtest.h>
#include <semantic_octree/store/NodeStore.h>

using namespace semantic_octree;

namespace {

constexpr VoxelBits kFirsts = 0x0101010101010101;  // of each octant

ClassRecord recordOf(ClassId id) {
  ClassRecord record{};
  record.count = 1;
  record.ids[0] = id;
  record.logOdds[0] = 500;
  return record;
}

/** Eight octants that are leaves of one value, each with the record of class 3. */
BlockContent agreeingOctants() {
  BlockContent content;
  const ClassRecord record = recordOf(3);
  for (int octant = 0; octant < 8; ++octant) content.setLeafOctant(octant, 500, &record);
  return content;
}

}  // namespace

TEST(NodeStore, aBlockWhoseOctantsAgreeBecomesALeaf) {
  NodeStore store(0);
  NodeArena& arena = store.arena(0);
  arena.createBlock(store.root(), agreeingOctants());
  ASSERT_TRUE(arena.prune(store.root()));
  EXPECT_EQ(store.root().kind, Slot::Kind::LeafWithRecord);
  EXPECT_EQ(store.root().value, 500);
  EXPECT_EQ(store.record(store.root()), recordOf(3));
  EXPECT_EQ(store.numNodes(), 1u);
}

TEST(NodeStore, aBlockStaysIfOneOctantHasNoRecordOrAnother) {
  for (int octant = 0; octant < 8; ++octant) {
    NodeStore store(0);
    NodeArena& arena = store.arena(0);
    arena.createBlock(store.root(), agreeingOctants());
    Block& block = store.block(store.root());
    store.record(block, 8 * octant) = recordOf(4);
    EXPECT_FALSE(arena.prune(store.root())) << "another in octant " << octant;
    store.record(block, 8 * octant) = recordOf(3);
    arena.setRecorded(block, kFirsts & ~(VoxelBits(1) << 8 * octant));
    EXPECT_FALSE(arena.prune(store.root())) << "none in octant " << octant;
    EXPECT_EQ(block.numRecords(), 7);
  }
}
