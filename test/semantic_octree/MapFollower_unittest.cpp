// What a map's readers are told, against what is different in the map.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/store/ChangeLog.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>

#include "FollowedTree.h"
#include "Voxels.h"

using namespace semantic_octree;

namespace {

/** RapidCheck draws the same cases in every run, unless told otherwise. */
const int kReadersSeedIsFixed = setenv("RC_PARAMS", "seed=20240517", 0);

using Tiles = std::set<VoxelId>;  // lowest voxel of each

VoxelId tileOf(const VoxelId& v) { return {v[0] & ~7, v[1] & ~7, v[2] & ~7}; }

std::map<VoxelId, std::map<VoxelId, std::vector<double>>> voxelsByTile(const SemanticOcTree& map) {
  std::map<VoxelId, std::map<VoxelId, std::vector<double>>> tiles;
  for (const auto& [v, p] : voxelsOf(map)) tiles[tileOf(v)][v] = p;
  return tiles;
}

Tiles tilesThatDiffer(const SemanticOcTree& before, const SemanticOcTree& after) {
  const auto a = voxelsByTile(before);
  Tiles different;
  for (const auto& [tile, voxels] : voxelsByTile(after)) {
    const auto old = a.find(tile);
    if (old == a.end() || old->second != voxels) different.insert(tile);
  }
  return different;
}

/** Tiles that differ, those that vanished among them. */
Tiles tilesOfBoth(const SemanticOcTree& before, const SemanticOcTree& after) {
  Tiles tiles = tilesThatDiffer(before, after);
  tiles.merge(tilesThatDiffer(after, before));
  return tiles;
}

Tiles asSet(const TileChange& change) {
  Tiles tiles;
  for (const octomap::OcTreeKey& k : change.tiles) tiles.insert(voxelAt(k[0], k[1], k[2]));
  return tiles;
}

AbstractionOptions someTerms(double alpha) {
  AbstractionOptions options;
  options.weights = {{tree_abstraction::relevant("1", 1, {1})}, alpha};
  return options;
}

ClassTable fadingClasses() {
  ClassTable table = numberedClasses(5);
  for (int id = 0; id < 4; ++id) table.setHalfLife(static_cast<ClassId>(id), 1 + id);
  return table;
}

/** What a reader knows of a map that it has read where it was told to. */
class Copy {
 public:
  explicit Copy(SemanticOcTree& map) : m_map(map), m_follower(map.follow()), m_tree(map) {}

  void look() {
    const TileChange change = m_follower.tiles();
    const Tiles told = asSet(change);
    if (change.all) m_voxels.clear();
    for (auto it = m_voxels.begin(); it != m_voxels.end();)
      it = told.count(tileOf(it->first)) ? m_voxels.erase(it) : std::next(it);
    const auto now = voxelsOf(m_map);
    for (const auto& [v, p] : now)
      if (told.count(tileOf(v))) m_voxels[v] = p;
    ASSERT_TRUE(m_voxels == now);
    m_tree.follow();
  }

 private:
  SemanticOcTree& m_map;
  MapFollower m_follower;
  FollowedTree m_tree;
  std::map<VoxelId, std::vector<double>> m_voxels;
};

/** Changes a map in one of all ways. */
class Changes {
 public:
  explicit Changes(SemanticOcTree& map) : m_map(map) {}

  void change(int way) {
    switch (way) {
      case 0:
        return m_map.clear();
      case 1:
        return m_map.swap(m_other);
      case 2:
        m_map = SemanticOcTree(m_other);
        return;
      case 3:
        m_other = std::move(m_map);
        return keepLeaves();
      case 4:
        dropAbstraction(m_map);
        return keepLeaves();
      case 5:
        return Abstraction(m_map).setWeights({between(m_random, -1, 2)}, between(m_random, 0, 0.1));
      case 6:
      case 7:
        return m_map.age(0.4);
      default:
        insert(m_map);
    }
  }

 private:
  void keepLeaves() { setAbstraction(m_map, someTerms(0.01)); }
  void insert(SemanticOcTree& map) {
    RandomScanOptions options;
    options.points = 60;
    options.reach = 3;
    const PosedCloud scan = randomScan(m_random, options);
    map.insert(scan.cloud, scan.T_map_sensor);
  }

  std::mt19937 m_random{7};
  SemanticOcTree& m_map;
  SemanticOcTree m_other = m_map;
};

TEST(MapFollower, readersAtRandomTimesKnowTheMapAndItsLeaves) {
  EXPECT_TRUE(rc::check([] {
    SemanticOcTree map(0.4, fadingClasses());
    setAbstraction(map, someTerms(0.01));
    Changes changes(map);
    std::optional<Copy> readers[3];
    for (const int step : *rc::gen::container<std::vector<int>>(25, rc::gen::inRange(0, 40))) {
      if (step < 20) {
        changes.change(step);
      } else if (auto& reader = readers[step % 3]; step < 23) {
        reader.reset();
      } else {
        if (!reader) reader.emplace(map);
        reader->look();
      }
      RC_ASSERT(!testing::Test::HasFailure());
    }
  }));
}

TEST(MapFollower, copiesOfAMapHaveNoReadersAndAMapThatIsGoneSaysSo) {
  std::mt19937 random(9);
  auto map = std::make_unique<SemanticOcTree>(0.4, numberedClasses(5));
  setAbstraction(*map, someTerms(0.01));
  MapFollower follower = map->follow();
  LeafFollower ofLeaves(*map);
  follower.skipTiles();
  ofLeaves.skipLeaves();
  SemanticOcTree copy = *map;
  const PosedCloud scan = randomScan(random);
  copy.insert(scan.cloud, scan.T_map_sensor);
  EXPECT_TRUE(follower.tiles().tiles.empty());
  EXPECT_TRUE(ofLeaves.leaves().added.empty());
  map = nullptr;
  EXPECT_THROW(follower.tiles(), std::logic_error);
  EXPECT_THROW(ofLeaves.leaves(), std::logic_error);
  EXPECT_THROW(follower.skipTiles(), std::logic_error);
}

TEST(MapFollower, leavesAreThoseOfAnAbstraction) {
  SemanticOcTree map(0.4, numberedClasses(5));
  LeafFollower follower(map);
  EXPECT_THROW(follower.leaves(), std::logic_error);
  setAbstraction(map, someTerms(0.01));
  EXPECT_TRUE(follower.leaves().all);
  EXPECT_FALSE(follower.leaves().all);
}

TEST(MapFollower, tilesAreThoseInWhichAVoxelChanged) {
  for (const int threads : {1, 2}) {
    std::mt19937 random(3);
    SemanticOcTree map(0.4, fadingClasses());
    InsertionOptions options;
    options.threads = threads;
    MapFollower follower = map.follow();
    EXPECT_TRUE(follower.tiles().tiles.empty());
    for (int i = 0; i < 12; ++i) {
      const SemanticOcTree before = map;
      const PosedCloud scan = randomScan(random);
      i % 2 ? map.age(0.3) : void(map.insert(scan.cloud, scan.T_map_sensor, options));
      EXPECT_EQ(asSet(follower.tiles()), tilesOfBoth(before, map)) << "step " << i;
      EXPECT_TRUE(follower.tiles().tiles.empty());
    }
  }
}

TEST(MapFollower, tilesAreAllThoseInALargerCubeThatChangesAsAWhole) {
  PosedCloud sphere;
  for (double up = -1.55; up < 1.56; up += 0.02)
    for (double around = 0; around < 6.28; around += 0.02)
      sphere.cloud.points.emplace_back(13 * std::cos(up) * std::cos(around),
                                       13 * std::cos(up) * std::sin(around), 13 * std::sin(up));
  SemanticOcTree map(0.4, numberedClasses(5));
  MapFollower follower = map.follow();
  follower.skipTiles();
  for (int i = 0; i < 2; ++i) {
    const SemanticOcTree before = map;
    map.insert(sphere.cloud, sphere.T_map_sensor);
    ASSERT_NE(map.search(octomap::OcTreeKey(32776, 32776, 32776), 12), nullptr);
    EXPECT_TRUE(map.search(octomap::OcTreeKey(32776, 32776, 32776), 12)->isLeaf());
    EXPECT_EQ(asSet(follower.tiles()), tilesThatDiffer(before, map));
  }
}

using Log = ChangeLog;
constexpr std::size_t kMost = 16;

/** A reader, and what it should know. */
struct LogReader {
  std::optional<Log::Place> place;
  std::vector<Log::Entry> unread;
  bool hasRead = false;

  void read() {
    if (!place->isLost())
      RC_ASSERT(std::vector<Log::Entry>(place->begin(), place->end()) == unread);
    place->moveToEnd();
    unread.clear();
    hasRead = true;
  }
  void end() {
    place.reset();
    hasRead = false;
  }
};

}  // namespace

TEST(ChangeLog, tellsEachReaderWhatItHasNotReadOrThatItIsLost) {
  EXPECT_TRUE(rc::check([] {
    const auto log = std::make_shared<Log>(kMost);
    LogReader readers[3];
    Log::Entry next = 0;
    for (const int step : *rc::gen::container<std::vector<int>>(200, rc::gen::inRange(0, 30))) {
      if (step < 3) {
        LogReader& reader = readers[step];
        if (reader.place && next % 7 == 0)
          reader.end();
        else if (reader.place)
          reader.read();
        else
          RC_ASSERT(reader.place.emplace(log).isLost());
      } else {
        log->push(++next);
        for (LogReader& reader : readers) reader.unread.push_back(next);
      }
      RC_ASSERT(log->size() <= kMost);
      for (const LogReader& reader : readers)
        if (reader.hasRead && reader.unread.size() <= kMost / 2) RC_ASSERT(!reader.place->isLost());
    }
  }));
}

TEST(ChangeLog, keepsNothingThatAllHaveRead) {
  const auto log = std::make_shared<Log>(kMost);
  Log::Place quick(log);
  quick.moveToEnd();
  {
    Log::Place slow(log);
    slow.moveToEnd();
    for (Log::Entry i = 0; i < 5; ++i) log->push(i);
    quick.moveToEnd();
    EXPECT_EQ(log->size(), 5u);
  }
  EXPECT_EQ(log->size(), 0u);
  EXPECT_TRUE(log->isRead());
}
