#include <gtest/gtest.h>
#include <map_correction/KeyframeMap.h>
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <map_streams/MapStream.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_abstraction/AlphaTrees.h>
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/TreeFile.h>

#include <optional>
#include <sstream>

#include "FailingAllocations.h"
#include "FollowedTree.h"
#include "RandomScans.h"
#include "TemporaryFolder.h"

using namespace semantic_octree;

namespace {

/** Few points: each allocation is made to fail, and all before it are made again. */
PosedCloud fewPoints(std::mt19937& random, int points = 100) {
  RandomScanOptions options;
  options.points = points;
  return randomScan(random, options);
}

SemanticOcTree mapOf(unsigned seed, int numScans, bool withAbstraction) {
  std::mt19937 random(seed);
  SemanticOcTree map(0.5, numberedClasses(5));
  if (withAbstraction) {
    AbstractionOptions options;
    options.weights = {
        {tree_abstraction::relevant("1", 1, {1}), tree_abstraction::irrelevant("2", 0.5, {2})},
        0.01};
    setAbstraction(map, options);
  }
  for (int i = 0; i < numScans; ++i) {
    const PosedCloud scan = fewPoints(random);
    map.insert(scan.cloud, scan.T_map_sensor);
  }
  return map;
}

semantic_types::ClassTable halfLives() {
  semantic_types::ClassTable classes = numberedClasses(5);
  for (const semantic_types::ClassId id : {0, 1, 2}) classes.setHalfLife(id, 1);
  return classes;
}

std::string bytesOf(const SemanticOcTree& map) {
  std::ostringstream out;
  writeTree(out, map);
  return out.str();
}

/** It answers nothing, but can begin anew. \param broken counts it; null: it should not be */
void expectLost(SemanticOcTree& map, int* broken) {
  EXPECT_NE(broken, nullptr);
  if (broken) ++*broken;
  EXPECT_THROW(map.size(), std::logic_error);
  EXPECT_THROW(map.root(), std::logic_error);
  EXPECT_THROW(SemanticOcTree copy(map), std::logic_error);
  map.clear();
  EXPECT_TRUE(map.empty());
}

/** Fails the first, the second, ... allocation of an operation on a map, until none is left to
 * fail. After a failure the map must be what it was, or say that it is broken.
 * \return how often it failed; `broken`: how often the map was lost */
template <typename F>
int sweep(const SemanticOcTree& before, const F& operation, int* broken = nullptr) {
  std::optional<SemanticOcTree> map;
  return failEachAllocation([&] { map.emplace(before); }, [&] { operation(*map); },
                            [&] {
                              if (map->isBroken())
                                expectLost(*map, broken);
                              else
                                EXPECT_TRUE(*map == before);
                            });
}

}  // namespace

TEST(FailingAllocations, whileAScanIsInsertedLeaveTheMapOrABrokenOne) {
  std::mt19937 random(3);
  const PosedCloud scan = fewPoints(random);
  int broken = 0, failures = 0;
  for (const bool withAbstraction : {false, true})
    for (const int threads : {1, 2}) {
      InsertionOptions options;
      options.threads = threads;
      failures += sweep(
          mapOf(4, 2, withAbstraction),
          [&](SemanticOcTree& map) { map.insert(scan.cloud, scan.T_map_sensor, options); },
          &broken);
    }
  EXPECT_GT(broken, 0);
  EXPECT_LT(broken, failures);
}

TEST(FailingAllocations, whileAMapAgesLeaveTheMapOrABrokenOne) {
  int broken = 0, failures = 0;
  for (const bool withAbstraction : {false, true}) {
    SemanticOcTree map = mapOf(4, 2, withAbstraction);
    map.setHalfLives(halfLives());
    failures += sweep(
        map, [](SemanticOcTree& m) { m.age(0.7); }, &broken);
  }
  EXPECT_GT(broken, 0);
  EXPECT_LT(broken, failures);
}

TEST(FailingAllocations, elsewhereLeaveTheMapAsItWas) {
  const SemanticOcTree map = mapOf(5, 2, true), other = mapOf(6, 1, false);
  std::stringstream file;
  writeTree(file, map);
  const std::string bytes = file.str();
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-2, -2, -2), Eigen::Vector3d(2, 2, 2));
  const Eigen::Isometry3d T(Eigen::Translation3d(0.3, 1, 0) *
                            Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()));
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { SemanticOcTree copy = m; }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { setAbstraction(m, Abstraction(m).options()); }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { Abstraction(m).leaves(); }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { AlphaTrees{Abstraction(m)}; }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { Abstraction(m).compressedMap(); }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { m.follow().tiles(); }), 3);
  EXPECT_GT(sweep(map, [&](SemanticOcTree& m) { merged({&m, &other}); }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { coarsened(m, 1); }), 3);
  EXPECT_GT(sweep(map, [&](SemanticOcTree& m) { cropped(m, box); }), 3);
  EXPECT_GT(sweep(map, [&](SemanticOcTree& m) { moved(m, T); }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { toOcTree(m); }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { toColorOcTree(m); }), 3);
  EXPECT_GT(sweep(map,
                  [&](SemanticOcTree& m) {
                    std::istringstream in(bytes);
                    m = readTree(in);
                  }),
            3);
}

TEST(FailingAllocations, whileKeyframesAreCorrectedLeaveTheMapOrABrokenOne) {
  std::mt19937 random(8);
  const PosedCloud a = fewPoints(random), b = fewPoints(random);
  const Eigen::Isometry3d T(Eigen::Translation3d(0.3, 1, 0));
  std::optional<SemanticOcTree> map;
  std::optional<KeyframeMap> keyframes;
  std::optional<SemanticOcTree> before;
  int broken = 0, failures = 0;
  const auto begin = [&] {
    keyframes.reset();
    map.emplace(mapOf(9, 0, true));
    map->setHalfLives(halfLives());
    keyframes.emplace(*map);
    keyframes->begin(T);
    keyframes->insert(a.cloud, a.T_map_sensor);
    keyframes->begin(Eigen::Isometry3d::Identity());
    keyframes->insert(b.cloud, b.T_map_sensor);
    before.emplace(*map);
  };
  begin();
  keyframes->insert(a.cloud, b.T_map_sensor);
  const SemanticOcTree grown = *map;
  const auto sweepKeyframes = [&](const auto& operation) {
    failures += failEachAllocation(
        begin, [&] { operation(*keyframes); },
        [&] {
          EXPECT_EQ(keyframes->numScans(), 2u);
          EXPECT_TRUE(keyframes->pose(0).isApprox(T));
          if (map->isBroken()) return expectLost(*map, &broken);
          EXPECT_TRUE(*map == *before);
          keyframes->insert(a.cloud, b.T_map_sensor);  // it can still grow, and be corrected
          EXPECT_TRUE(*map == grown);
          keyframes->remove({0, 1});
          EXPECT_TRUE(map->empty());
        });
  };
  sweepKeyframes([&](KeyframeMap& k) { k.move({{0, Eigen::Isometry3d::Identity()}}); });
  sweepKeyframes([&](KeyframeMap& k) { k.remove({0}); });
  sweepKeyframes([&](KeyframeMap& k) { k.insert(a.cloud, a.T_map_sensor, {}, 0.7); });
  EXPECT_GT(broken, 0);
  EXPECT_LT(broken, failures);
}

TEST(FailingAllocations, ofWhoFollowsLeaveNoReaderBlind) {
  const SemanticOcTree before = mapOf(7, 2, true);
  std::mt19937 random(8);
  const PosedCloud scan = fewPoints(random);
  std::optional<SemanticOcTree> map;
  std::optional<FollowedTree> first, second;
  const int failures = failEachAllocation(
      [&] {
        map.emplace(before);
        for (auto* tree : {&first, &second}) tree->emplace(*map).follow();
        map->insert(scan.cloud, scan.T_map_sensor);
      },
      [&] { LeafFollower(*map).leaves(); },
      [&] {
        for (auto* tree : {&first, &second}) (*tree)->follow();
      });
  EXPECT_GT(failures, 3);
}

TEST(FailingAllocations, whileTilesComeAndGoLeaveTheMapOrABrokenOne) {
  const TemporaryFolder folder;
  std::string expected;
  MapFolderOptions tight;
  tight.memory = 0;
  tight.tileSize = 16;
  {
    SemanticOcTree map = mapOf(1, 0, true);
    MapFolder tiles(map, folder.path(), MapFolder::Access::Write, tight);
    std::mt19937 random(10);
    const PosedCloud scan = fewPoints(random, 40);
    map.insert(scan.cloud, scan.T_map_sensor);
    tiles.save();
    expected = bytesOf(map);
  }
  std::optional<SemanticOcTree> map;
  std::optional<MapFolder> tiles;
  int broken = 0;
  const int failures = failEachAllocation(
      [&] {
        tiles.reset();
        map.emplace(mapOf(1, 0, true));
        tiles.emplace(*map, folder.path(), MapFolder::Access::Read, tight);
      },
      [&] {
        bytesOf(*map);
        const SemanticOcTree copy(*map);
      },
      [&] {
        if (map->isBroken()) return expectLost(*map, &broken);
        EXPECT_EQ(bytesOf(*map), expected);
      });
  EXPECT_LT(broken, failures);
  EXPECT_EQ(bytesOf(loadMap(folder.path().string())), expected);
}

TEST(FailingAllocations, whileAMapIsSavedLeaveTheOldFile) {
  const SemanticOcTree old = mapOf(8, 1, false);
  const std::string path = testing::TempDir() + "failing_allocations.semantic";
  saveTree(old, path);
  const SemanticOcTree map = mapOf(9, 2, false);
  EXPECT_GT(failEachAllocation([] {}, [&] { saveTree(map, path); },
                               [&] { EXPECT_TRUE(loadTree(path) == old); }),
            3);
  EXPECT_TRUE(loadTree(path) == map);
}

TEST(FailingAllocations, aReceiverTakesAPacketThatFailedAgain) {
  SemanticOcTree map = mapOf(3, 6, true);
  Abstraction(map).setAlpha(0);
  MapSender sender(1);
  sender.setMap(map);
  std::vector<Datagram> packets;
  while (const auto packet = sender.next()) packets.push_back(*packet);
  ASSERT_GT(packets.size(), 4u);
  const std::size_t half = packets.size() / 2;
  const SemanticOcTree expected = Abstraction(map).compressedMap();
  std::optional<MapReceiver> receiver;
  const auto prepare = [&] {
    receiver.emplace(1);
    for (std::size_t i = packets.size() - 1; i > half; --i) receiver->accept(packets[i]);
  };
  const auto takeTheRest = [&] {
    for (std::size_t i = 0; i <= half; ++i) receiver->accept(packets[i]);
  };
  const int failures = failEachAllocation(prepare, takeTheRest, [&] {
    takeTheRest();
    EXPECT_TRUE(receiver->isFinished());
    EXPECT_TRUE(receiver->map() == expected);
  });
  EXPECT_GT(failures, 30);
}

TEST(FailingAllocations, aBroadcastTellsEverythingAfterAFailureAndACopyTakesIt) {
  SemanticOcTree map = mapOf(2, 6, true);
  const SemanticOcTree before(map);
  const SemanticOcTree other = mapOf(3, 7, true);
  std::optional<TreeBroadcast> sender;
  std::optional<TreeCopy> copy;
  const auto prepare = [&] {
    map = before;
    sender.emplace(map, 1);
    copy.emplace();
    copy->accept(sender->change());
    map = other;
  };
  const auto tell = [&] { copy->accept(sender->change()); };
  const int failures = failEachAllocation(prepare, tell, [&] {
    if (const std::string change = sender->change(); !change.empty()) copy->accept(change);
    EXPECT_TRUE(copy->accept(sender->all()));
    EXPECT_TRUE(copy->map() == Abstraction(map).compressedMap());
  });
  EXPECT_GT(failures, 30);
}
