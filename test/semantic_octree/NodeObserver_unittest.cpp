// The seam of the store: an observer of another kind than the abstraction's.
#include <gtest/gtest.h>
#include <map_correction/KeyframeMap.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/store/FusionRule.h>
#include <semantic_octree/store/MapAccess.h>

#include <algorithm>
#include <deque>

#include "PlainMap.h"
#include "RandomScans.h"

using namespace semantic_octree;

namespace {

/** Keeps of each inner node how many voxels are known below it. */
class VoxelCounter final : public NodeObserver {
 public:
  static std::uint64_t known(const NodeStore& store, const Slot& slot, const Cube& cell) {
    const auto edge = static_cast<std::uint64_t>(cell.edge());
    if (slot.isInner()) return *store.state<std::uint64_t>(slot);
    return slot.isKnown() ? edge * edge * edge : 0;
  }

  std::size_t stateBytes() const override { return sizeof(std::uint64_t); }
  Worker& worker(int i) override {
    while (static_cast<int>(m_workers.size()) <= i) m_workers.emplace_back();
    return m_workers[i];
  }
  bool sameState(const NodeStore& a, const Slot& inA, const NodeStore& b,
                 const Slot& inB) const override {
    return *a.state<std::uint64_t>(inA) == *b.state<std::uint64_t>(inB);
  }
  void tellAll() override {}
  std::unique_ptr<NodeObserver> clone() const override { return std::make_unique<VoxelCounter>(); }

 private:
  struct Counting final : Worker {
    void recompute(NodeStore& store, Slot& inner, const Cube& cell, bool) override {
      std::uint64_t sum = 0;
      if (inner.kind == Slot::Kind::Block)
        sum = static_cast<std::uint64_t>(countOf(store.block(inner).known));
      else
        for (int i = 0; i < 8; ++i)
          sum += known(store, store.octant(inner).slots[i], cell.child(i));
      *store.state<std::uint64_t>(inner) = sum;
    }
  };
  std::deque<Counting> m_workers;
};

void observe(SemanticOcTree& map) { MapAccess::setObserver(map, std::make_unique<VoxelCounter>()); }

/** What is kept is what the leaves tell, and what an observer that comes now finds. */
void expectUpToDate(const SemanticOcTree& map) {
  std::uint64_t voxels = 0;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf)
    voxels += std::uint64_t(1) << 3 * (map.getTreeDepth() - leaf.getDepth());
  const NodeStore& store = MapAccess::store(map);
  EXPECT_EQ(VoxelCounter::known(store, store.root(), Cube()), voxels);
  SemanticOcTree anew = map;
  EXPECT_TRUE(anew == map);
  observe(anew);
  EXPECT_TRUE(anew == map);
}

ClassTable agingTable() {
  ClassTable classes = numberedClasses(5);
  for (const ClassId id : {0, 2, 4}) classes.setHalfLife(id, 8);
  return classes;
}

TEST(NodeObserver, isAskedWhereAMapChangesOrIsCorrected) {
  for (const bool pruning : {true, false}) {
    std::mt19937 random(4);
    SemanticOcTree map(0.4, agingTable());
    map.setPruning(pruning);
    observe(map);
    InsertionOptions options;
    for (int i = 0; i < 8; ++i) {
      options.threads = 1 + i % 3;
      const PosedCloud scan = randomScan(random);
      map.insert(scan.cloud, scan.T_map_sensor, options, 3);
      expectUpToDate(map);
    }
    map.age(100);
    expectUpToDate(map);
    map.clear();
    expectUpToDate(map);
    KeyframeMap keyframes(map);
    for (int i = 0; i < 5; ++i) {
      const PosedCloud scan = randomScan(random);
      keyframes.begin(scan.T_map_sensor);
      keyframes.insert(scan.cloud, Eigen::Isometry3d::Identity());
    }
    keyframes.move({{2, keyframes.pose(2) * Eigen::Translation3d(1.3, 0, 0)}});
    expectUpToDate(map);
    keyframes.remove({3});
    expectUpToDate(map);
  }
}

TEST(NodeObserver, isTheOnlyOneOfItsMapAndComparedWithItsKindAlone) {
  std::mt19937 random(6);
  SemanticOcTree map(0.4, numberedClasses(5));
  const PosedCloud scan = randomScan(random);
  map.insert(scan.cloud, scan.T_map_sensor);
  SemanticOcTree other = map;
  AbstractionOptions options;
  options.weights = {{tree_abstraction::relevant("first", 1, {1})}, 0.01};
  setAbstraction(other, options);
  observe(map);
  EXPECT_TRUE(map == other);
  EXPECT_FALSE(hasAbstraction(map));
  observe(other);
  EXPECT_FALSE(hasAbstraction(other));
  EXPECT_THROW(Abstraction{other}, std::logic_error);
  expectUpToDate(other);
}

// Another rule than the class filter, of which nothing else knows.

constexpr int kClasses = 5;
constexpr Units kSure = 4 * kUnitsPerLogOdds;

/** A voxel is what the last scan saw there: free, occupied, or the class that most labels name (of
 * several, the lowest id). */
class LastSeen final : public BlockFusion {
 public:
  LastSeen(NodeStore& store, NodeArena& arena, bool pruning)
      : m_store(store), m_arena(arena), m_pruning(pruning) {}

  bool miss(Slot& leaf) override {
    if (leaf.kind == Slot::Kind::LeafWithRecord) m_arena.dropRecord(leaf);
    leaf.value = -kSure;
    return true;
  }
  Units lowest() const override { return -kSure; }
  Result update(Block& block, const BlockScan& scan) override {
    BlockContent voxels = opened(m_store.contentOf(block));
    voxels.recorded &= ~scan.touched();
    std::uint32_t rank = scan.firstHit;
    for (int v = 0; v < 64; ++v) {
      if (scan.free >> v & 1) voxels.setVoxel(v, -kSure, nullptr);
      if (scan.hit >> v & 1) see(scan.votes.votesOf(rank++), v, voxels);
    }
    for (int o = 0; m_pruning && o < 8; ++o) voxels.mergeOctant(o);
    m_arena.fill(block, voxels);
    return {true, true};
  }

 private:
  /** Octants that are leaves become voxels that say the same. */
  static BlockContent opened(BlockContent block) {
    for (int v = 0; v < 64; ++v) {
      const int first = v & ~7;
      if (!(block.leafOctants >> v / 8 & 1)) continue;
      block.setVoxel(v, block.values[first],
                     block.recorded >> first & 1 ? &block.records[first] : nullptr);
    }
    block.leafOctants = 0;
    return block;
  }
  static void see(const HitVotes::Result& seen, int voxel, BlockContent& voxels) {
    const auto fewer = [](const ClassVotes& x, const ClassVotes& y) { return x.count < y.count; };
    if (seen.numVoted == 0) return voxels.setVoxel(voxel, kSure, nullptr);
    ClassRecord record{};
    record.rest = -kSure;
    record.count = 1;
    record.ids[0] =
        std::max_element(seen.votes.begin(), seen.votes.begin() + seen.numVoted, fewer)->id;
    record.logOdds[0] = kSure;
    voxels.setVoxel(voxel, kSure, &record);
  }

  NodeStore& m_store;
  NodeArena& m_arena;
  bool m_pruning;
};

struct LastSeenRule final : FusionRule {
  std::unique_ptr<BlockFusion> begin(NodeStore& store, NodeArena& arena, bool pruning,
                                     const LabelReliability&) const override {
    return std::make_unique<LastSeen>(store, arena, pruning);
  }
};

SemanticOcTree emptyMap() {
  SemanticOcTree map(0.4, numberedClasses(kClasses));
  MapAccess::setRule(map, std::make_shared<LastSeenRule>());
  return map;
}

std::vector<PosedCloud> someScans() {
  std::mt19937 random(3);
  std::vector<PosedCloud> scans;
  for (int i = 0; i < 8; ++i) scans.push_back(randomScan(random));
  return scans;
}

/** By class id, how many points of a scan name it. */
std::array<int, kClasses + 1> votesOf(const std::vector<std::size_t>& points,
                                      const semantic_types::LabeledCloud& cloud) {
  std::array<int, kClasses + 1> votes{};
  for (const std::size_t i : points) ++votes[cloud.classes[i]];
  votes[kNoClass] = 0;
  return votes;
}

}  // namespace

TEST(FusionRule, ofOthersIsUsedForAllThatScansSee) {
  SemanticOcTree map = emptyMap();
  std::map<VoxelId, ClassId> expected;  // 0: free, kClasses + 1: occupied
  for (const PosedCloud& scan : someScans()) {
    map.insert(scan.cloud, scan.T_map_sensor);
    const PlainScan seen = plainScan(scan, 0.4, {});
    for (const VoxelId& voxel : seen.free) expected[voxel] = kNoClass;
    for (const auto& [voxel, points] : seen.hits) {
      const auto votes = votesOf(points, scan.cloud);
      const auto most = std::max_element(votes.begin(), votes.end());
      expected[voxel] = static_cast<ClassId>(*most ? most - votes.begin() : kClasses + 1);
    }
  }
  std::array<int, kClasses + 2> found{};
  for (const auto& [voxel, id] : expected) {
    const CellState state = map.query(keyOf(voxel));
    ASSERT_EQ(state.status, id ? CellState::Status::Occupied : CellState::Status::Free);
    if (id >= 1 && id <= kClasses) {
      ASSERT_EQ(state.likeliestClass, id);
    }
    ++found[id];
  }
  for (const int n : found) EXPECT_GT(n, 20);
}

TEST(FusionRule, goesWithCopiesAndCorrections) {
  const auto scans = someScans();
  SemanticOcTree map = emptyMap(), expected = map;
  KeyframeMap keyframes(map);
  for (const PosedCloud& scan : scans) {
    keyframes.begin(Eigen::Isometry3d::Identity());
    keyframes.insert(scan.cloud, scan.T_map_sensor);
  }
  const Eigen::Isometry3d T(Eigen::Translation3d(0.7, 0.2, -0.3));
  keyframes.move({{2, T}});
  for (std::size_t i = 0; i < scans.size(); ++i)
    expected.insert(scans[i].cloud, i == 2 ? T * scans[i].T_map_sensor : scans[i].T_map_sensor);
  EXPECT_TRUE(map == expected);
  SemanticOcTree moved = std::move(expected);
  for (SemanticOcTree* each : {&map, &moved}) each->insert(scans[0].cloud, T);
  EXPECT_TRUE(map == moved);
  EXPECT_THROW(MapAccess::setRule(map, nullptr), std::logic_error);
}
