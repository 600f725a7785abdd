// The seam of the store: an observer of another kind than the abstraction's.
#include <gtest/gtest.h>
#include <map_correction/KeyframeMap.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/store/MapAccess.h>

#include <deque>

#include "RandomScans.h"

using namespace semantic_octree;

namespace {

/** Keeps of each inner node how many voxels are known below it. */
class VoxelCounter final : public NodeObserver {
 public:
  static std::uint64_t known(const NodeStore& store, const Slot& slot, const Cell& cell) {
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
    void recompute(NodeStore& store, Slot& inner, const Cell& cell, bool) override {
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
  EXPECT_EQ(VoxelCounter::known(store, store.root(), Cell()), voxels);
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

}  // namespace

TEST(NodeObserver, isAskedWhereAMapChanges) {
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
  }
}

TEST(NodeObserver, isAskedWhereAMapIsCorrected) {
  std::mt19937 random(5);
  SemanticOcTree map(0.4, numberedClasses(5));
  observe(map);
  KeyframeMap keyframes(map);
  for (int i = 0; i < 5; ++i) {
    const PosedCloud scan = randomScan(random);
    keyframes.begin(scan.T_map_sensor);
    keyframes.insert(scan.cloud, Eigen::Isometry3d::Identity());
  }
  Eigen::Isometry3d there = keyframes.pose(2);
  there.translation().x() += 1.3;
  keyframes.move({{2, there}});
  expectUpToDate(map);
  keyframes.remove(3);
  expectUpToDate(map);
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
