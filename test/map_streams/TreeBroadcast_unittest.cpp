#include <gtest/gtest.h>

#include <set>

#include "StreamedMaps.h"
#include "TemporaryFolder.h"

namespace {

using namespace streamed_maps;

/** A map that is told of, and a copy. */
struct Broadcast {
  explicit Broadcast(const AbstractionOptions& options) : map(0.2, numberedClasses(K)) {
    setAbstraction(map, options);
  }
  void insert(const PosedCloud& scan) { map.insert(scan.cloud, scan.T_map_sensor); }
  /** Tells the copy what changed. \return whether it is the tree */
  bool isTold() {
    if (const std::string change = sender.change(); !change.empty()) copy.accept(change);
    return copy.isCurrent() && fileOf(copy.map()) == tree();
  }
  std::string tree() { return fileOf(Abstraction(map).compressedMap()); }

  SemanticOcTree map;
  TreeBroadcast sender{map, kStream};
  TreeCopy copy;
};

AbstractionOptions options(double alpha, double blockSize, AbstractionOptions::Frame frame) {
  AbstractionOptions options = someOptions(alpha);
  options.blockSize = blockSize;
  options.frame = frame;
  return options;
}

TEST(TreeBroadcast, copiesAreTheTreeToTheLastBitAfterEachChange) {
  const auto scans = scansOfSmallPlace(6, 800, K, 7);
  for (const double alpha : {0.0, 0.003, 0.02})
    for (const double blockSize : {0.0, 0.2, 3.2, 100.0})
      for (const auto frame :
           {AbstractionOptions::Frame::Free, AbstractionOptions::Frame::Charged}) {
        Broadcast b(options(alpha, blockSize, frame));
        for (std::size_t i = 0; i < scans.size(); ++i) {
          b.insert(scans[i]);
          ASSERT_TRUE(b.isTold()) << alpha << " " << blockSize << " " << i;
          TreeCopy late;
          ASSERT_TRUE(late.accept(b.sender.all()));
          ASSERT_TRUE(fileOf(late.map()) == b.tree()) << alpha << " " << blockSize << " " << i;
          EXPECT_EQ(b.sender.change(), "");
        }
      }
}

/** Seen often, free space has the lowest value, and merges; what is seen anew parts it again. */
TEST(TreeBroadcast, leavesAboveTheBlocksMergeAndPart) {
  Broadcast b(options(0.003, 0.2, AbstractionOptions::Frame::Free));
  const PosedCloud scan = scansOfSmallPlace(1, 6000, K, 3)[0];
  std::mt19937 random(1);
  RandomScanOptions few;
  few.classes = K;
  std::size_t large = 0;
  for (int round = 0; round < 30; ++round) {
    b.insert(round % 10 == 9 ? randomScan(random, few) : scan);
    ASSERT_TRUE(b.isTold()) << round;
    const SemanticOcTree tree = b.copy.map();
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
      large += leaf.getDepth() < static_cast<unsigned>(Abstraction(b.map).rootDepth());
  }
  EXPECT_GT(large, 100u);
}

TEST(TreeBroadcast, theTreeMayBecomeAnother) {
  Broadcast b(someOptions(0.003));
  const auto scans = scansOfSmallPlace(2, 2000, K, 7);
  b.insert(scans[0]);
  EXPECT_TRUE(b.isTold());
  for (const double alpha : {0.02, 0.0, 10.0, 0.001}) {
    Abstraction(b.map).setAlpha(alpha);
    EXPECT_TRUE(b.isTold()) << alpha;
  }
  setAbstraction(b.map, options(0.003, 6.4, AbstractionOptions::Frame::Free));
  EXPECT_TRUE(b.isTold());
  b.map.clear();
  EXPECT_TRUE(b.isTold());
  EXPECT_TRUE(b.copy.map().empty());
  b.insert(scans[1]);
  EXPECT_TRUE(b.isTold());
  dropAbstraction(b.map);
  EXPECT_THROW(b.sender.change(), std::logic_error);
  setAbstraction(b.map, someOptions(0.01));
  EXPECT_TRUE(b.isTold());
  SemanticOcTree other(0.2, numberedClasses(K + 1));
  setAbstraction(other, someOptions(0.01));
  b.map = other;
  EXPECT_TRUE(b.isTold());
}

TEST(TreeBroadcast, tellsWhatTheTreeStatesOnceTheMapIsCalibrated) {
  Broadcast b(someOptions(0.001));
  for (const PosedCloud& scan : scansOfSmallPlace(3, 2000, K, 7)) b.insert(scan);
  std::set<std::string> trees;
  for (const double power : {1.0, 0.5, 0.8, 0.9}) {
    b.map.setCalibration({power, power < 1 ? 0.1 : 0});
    std::vector<double> factors(K, 0.5);
    factors[0] = 3;
    if (power == 0.9) b.map.setCalibration({power, 0.1, factors});
    EXPECT_TRUE(b.isTold()) << power;
    trees.insert(b.tree());
    TreeCopy late;
    EXPECT_TRUE(late.accept(b.sender.all()));
    EXPECT_TRUE(fileOf(late.map()) == b.tree()) << power;
  }
  EXPECT_EQ(trees.size(), 4u);
}

TEST(TreeBroadcast, aChangeTakesWhatChanged) {
  Broadcast b(someOptions(0.003));
  for (const PosedCloud& scan : scansOfSmallPlace(4, 2500, K, 7)) b.insert(scan);
  const std::size_t all = b.sender.change().size();
  EXPECT_LE(b.sender.all().size(), all);
  b.insert(scansOfSmallPlace(1, 60, K, 5)[0]);
  EXPECT_LT(b.sender.change().size(), all / 3);
}

TEST(TreeBroadcast, whatIsLostIsNoticed) {
  Broadcast b(someOptions(0.003));
  std::vector<std::string> changes, trees, alls;
  for (const PosedCloud& scan : scansOfSmallPlace(6, 800, K, 7)) {
    b.insert(scan);
    changes.push_back(b.sender.change());
    alls.push_back(b.sender.all());
    trees.push_back(b.tree());
  }
  TreeCopy& copy = b.copy;
  EXPECT_FALSE(copy.isCurrent());
  EXPECT_THROW(copy.map(), std::logic_error);
  EXPECT_TRUE(copy.accept(changes[0]));
  EXPECT_FALSE(copy.accept(changes[2]));
  EXPECT_TRUE(fileOf(copy.map()) == trees[0]) << "what was right before";
  EXPECT_FALSE(copy.accept(alls[0])) << "too old";
  EXPECT_FALSE(copy.accept(changes[3]));
  EXPECT_TRUE(copy.accept(alls[1])) << "what came too early is not lost";
  EXPECT_TRUE(fileOf(copy.map()) == trees[3]);
  EXPECT_TRUE(copy.accept(changes[1])) << "is known";
  EXPECT_TRUE(copy.accept(changes[4]));
  EXPECT_TRUE(copy.accept(changes[5]));
  EXPECT_TRUE(fileOf(copy.map()) == trees[5]);
}

TEST(TreeBroadcast, othersBytesAndAnotherRunAreNoChanges) {
  Broadcast b(someOptions(0.003));
  b.insert(scansOfSmallPlace(1, 500, K, 7)[0]);
  const std::string all = b.sender.change();
  EXPECT_THROW(b.copy.accept("hello, world"), std::runtime_error);
  for (std::size_t at = 0; at < all.size(); at += 37) {
    std::string altered = all;
    altered[at] = static_cast<char>(altered[at] ^ 1);
    EXPECT_THROW(b.copy.accept(altered), std::runtime_error) << at;
    EXPECT_THROW(b.copy.accept(all.substr(0, at)), std::runtime_error) << at;
  }
  EXPECT_TRUE(b.copy.accept(all));
  SemanticOcTree second = smallPlace(someOptions(0.01));
  TreeBroadcast anotherRun(second, kStream + 1);
  EXPECT_TRUE(b.copy.accept(anotherRun.change()));
  EXPECT_TRUE(fileOf(b.copy.map()) == fileOf(Abstraction(second).compressedMap()));
}

}  // namespace
