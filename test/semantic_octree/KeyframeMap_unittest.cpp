#include <gtest/gtest.h>
#include <semantic_octree/Abstraction.h>
#include <semantic_octree/KeyframeMap.h>

#include <set>
#include <tuple>

#include "RandomScans.h"
#include "TemporaryFolder.h"
#include "Voxels.h"

using namespace semantic_octree;

namespace {

/** A map of keyframes, and by hand what it has to hold. */
struct Variant {
  const char* name;
  bool softLabels = false, pruning = true, onDisk = false;
  int threads = 1;
  AbstractionOptions::Frame frame = AbstractionOptions::Frame::Free;
  InsertionOptions::Rays rays = InsertionOptions::Rays::All;
  bool ages = false;
  double alpha = 0.01;
  double blockSize = AbstractionOptions().blockSize;
};

AbstractionOptions abstractionOf(const Variant& variant) {
  AbstractionOptions options;
  options.weights.terms = {tree_abstraction::relevant("1", 1, {1}),
                           tree_abstraction::irrelevant("2", 0.5, {2})};
  options.weights.alpha = variant.alpha;
  options.blockSize = variant.blockSize;
  options.frame = variant.frame;
  return options;
}

SemanticOcTree emptyMap(const Variant& variant, const FilterParameters& filter = {}) {
  semantic_types::ClassTable classes = numberedClasses(5);
  for (const semantic_types::ClassId id : {0, 1, 2, 3})
    if (variant.ages) classes.setHalfLife(id, 0.7 + 0.4 * id);
  SemanticOcTree map(0.4, classes, filter);
  map.setPruning(variant.pruning);
  map.setAbstraction(abstractionOf(variant));
  return map;
}

InsertionOptions optionsOf(const Variant& variant) {
  InsertionOptions options;
  options.threads = variant.threads;
  options.rays = variant.rays;
  options.maxRange = 6;
  return options;
}

/** Scans that were inserted, in their order: the oracle. */
class Scans {
 public:
  struct Entry {
    KeyframeId keyframe;
    PosedCloud scan;        ///< its pose is that in the keyframe
    std::int64_t time = 0;  ///< ms
  };
  std::vector<Eigen::Isometry3d> poses;
  std::vector<Entry> all;
  std::int64_t now = 0;  ///< ms

  SemanticOcTree mappedFromScratch(const Variant& variant,
                                   const FilterParameters& filter = {}) const {
    SemanticOcTree map = emptyMap(variant, filter);
    std::int64_t time = 0;
    for (const Entry& e : all) {
      map.insert(e.scan.cloud, poses[e.keyframe] * e.scan.T_map_sensor, optionsOf(variant),
                 1e-3 * static_cast<double>(e.time - time));
      time = e.time;
    }
    map.age(1e-3 * static_cast<double>(now - time));
    return map;
  }
  void removeOf(KeyframeId keyframe) {
    all.erase(std::remove_if(all.begin(), all.end(),
                             [keyframe](const Entry& e) { return e.keyframe == keyframe; }),
              all.end());
  }
};

using CellId = std::tuple<int, int, int, unsigned>;

CellId idOf(const LeafCell& leaf) { return {leaf.key[0], leaf.key[1], leaf.key[2], leaf.depth}; }

std::set<CellId> leavesOf(const Abstraction& abstraction) {
  std::set<CellId> ids;
  for (const LeafCell& leaf : abstraction.leaves()) ids.insert(idOf(leaf));
  return ids;
}

/** Lowest voxels of tiles in which voxels are not what they were. */
std::set<VoxelId> tilesThatDiffer(const SemanticOcTree& before, const SemanticOcTree& after) {
  const auto a = voxelsOf(before), b = voxelsOf(after);
  std::set<VoxelId> tiles;
  const auto compare = [&tiles](const auto& x, const auto& y) {
    for (const auto& [v, p] : x) {
      const auto other = y.find(v);
      if (other == y.end() || other->second != p) tiles.insert({v[0] & ~7, v[1] & ~7, v[2] & ~7});
    }
  };
  compare(a, b);
  compare(b, a);
  return tiles;
}

std::set<VoxelId> asSet(const std::vector<octomap::OcTreeKey>& keys) {
  std::set<VoxelId> tiles;
  for (const octomap::OcTreeKey& k : keys) tiles.insert(voxelAt(k[0], k[1], k[2]));
  return tiles;
}

/** Does something at random to a map, and the same to the oracle. */
class RandomWork {
 public:
  RandomWork(unsigned seed, const Variant& variant, KeyframeMap& map)
      : m_random(seed), m_variant(variant), m_map(map) {}

  void step() {
    const auto choice = m_random() % 8;
    if (m_present.empty() || choice < 2) return begin();
    if (choice < 5) return insert();
    if (choice < 7) return move();
    remove();
  }
  Scans scans;

 private:
  void begin() {
    scans.poses.push_back(randomPose(m_random, 3));
    m_present.push_back(m_map.begin(scans.poses.back()));
    insert();
  }
  void insert() {
    if (m_present.back() + 1 != scans.poses.size()) return begin();  // the last one was removed
    RandomScanOptions options;
    options.softLabels = m_variant.softLabels;
    options.sensorSpread = 1;
    PosedCloud scan = randomScan(m_random, options);
    const auto since = m_variant.ages ? static_cast<std::int64_t>(m_random() % 400) : 0;  // ms
    scans.now += since;
    m_map.insert(scan.cloud, scan.T_map_sensor, optionsOf(m_variant),
                 1e-3 * static_cast<double>(since));
    scans.all.push_back({m_present.back(), std::move(scan), scans.now});
  }
  /** One keyframe far, another a little. */
  void move() {
    std::vector<KeyframePose> poses;
    for (const double spread : {3.0, 0.05}) {
      const KeyframeId id = any();
      Eigen::Isometry3d T = spread > 1 ? randomPose(m_random, spread) : scans.poses[id];
      if (spread < 1) T.translation() += randomPose(m_random, spread).translation();
      scans.poses[id] = T;
      poses.push_back({id, T});
    }
    m_map.move(poses);
  }
  void remove() {
    const KeyframeId id = any();
    m_map.remove(id);
    scans.removeOf(id);
    m_present.erase(std::find(m_present.begin(), m_present.end(), id));
  }
  KeyframeId any() { return m_present[m_random() % m_present.size()]; }

  std::mt19937 m_random;
  const Variant& m_variant;
  KeyframeMap& m_map;
  std::vector<KeyframeId> m_present;
};

class CorrectedMap : public testing::TestWithParam<Variant> {
 protected:
  const TemporaryFolder m_folder;

  std::unique_ptr<KeyframeMap> keyframesOf(SemanticOcTree& map) const {
    return GetParam().onDisk ? std::make_unique<KeyframeMap>(map, m_folder.path())
                             : std::make_unique<KeyframeMap>(map);
  }
};

}  // namespace

TEST_P(CorrectedMap, isWhatMappingFromScratchMakesAfterAnyInsertionsMovesAndRemovals) {
  const Variant& variant = GetParam();
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SemanticOcTree map = emptyMap(variant);
    const auto keyframes = keyframesOf(map);
    RandomWork work(seed, variant, *keyframes);
    for (int i = 0; i < 14; ++i) {
      work.step();
      map.age(0.1);
      work.scans.now += 100;
      const SemanticOcTree expected = work.scans.mappedFromScratch(variant);
      ASSERT_TRUE(map == expected) << variant.name << ", seed " << seed << ", step " << i;
      EXPECT_EQ(map.size(), expected.size());
      EXPECT_EQ(map.memoryUsage(), expected.memoryUsage());
      EXPECT_EQ(keyframes->numScans(), work.scans.all.size());
    }
  }
}

TEST_P(CorrectedMap, tellsItsChangesAsAMapThatGrowsDoes) {
  const Variant& variant = GetParam();
  SemanticOcTree map = emptyMap(variant);
  const auto keyframes = keyframesOf(map);
  map.takeTouchedTiles();
  std::set<CellId> told;
  RandomWork work(7, variant, *keyframes);
  for (int i = 0; i < 40; ++i) {
    const SemanticOcTree before = map;
    work.step();
    if (map == before) continue;
    const auto touched = asSet(map.takeTouchedTiles()), differ = tilesThatDiffer(before, map);
    EXPECT_TRUE(std::includes(touched.begin(), touched.end(), differ.begin(), differ.end()));
    if (i % 2) continue;  // changes add up
    Abstraction abstraction(map);
    const TreeChange change = abstraction.takeChange();
    for (const LeafCell& leaf : change.removed) EXPECT_EQ(told.erase(idOf(leaf)), 1u);
    for (const LeafCell& leaf : change.added) EXPECT_TRUE(told.insert(idOf(leaf)).second);
    ASSERT_EQ(told, leavesOf(abstraction)) << "step " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Variants, CorrectedMap,
    testing::Values(Variant{"hard"}, Variant{"soft", true}, Variant{"unpruned", false, false},
                    Variant{"onDisk", false, true, true}, Variant{"threads", true, true, true, 2},
                    Variant{"chargedFrame", false, true, false, 1,
                            AbstractionOptions::Frame::Charged},
                    Variant{"endVoxels", false, true, false, 1, AbstractionOptions::Frame::Free,
                            InsertionOptions::Rays::EndVoxels},
                    Variant{"ages", true, true, true, 2, AbstractionOptions::Frame::Free,
                            InsertionOptions::Rays::All, true},
                    Variant{"coarse", false, true, false, 1, AbstractionOptions::Frame::Free,
                            InsertionOptions::Rays::All, true, 0.15, 1.6}),
    [](const auto& variant) { return variant.param.name; });

/** Limits that are never met, labels that never disagree: then sums are all there is. */
TEST(KeyframeMap, awayFromTheLimitsTheOrderOfScansLeavesNoTrace) {
  const Variant variant{"wide"};
  FilterParameters wide;
  wide.minOccupancy = 1e-9;
  wide.maxProbability = 1 - 1e-9;
  wide.accuracy = 0.4;  // the more a label says, the fewer reach the limits
  std::mt19937 random(5);
  RandomScanOptions options;
  options.classes = 3;
  options.sensorSpread = 0.3;
  Scans forward;
  for (KeyframeId id = 0; id < 6; ++id) {
    forward.poses.push_back(Eigen::Isometry3d::Identity());
    forward.all.push_back({id, randomScan(random, options), 0});
  }
  Scans backward = forward;
  std::reverse(backward.all.begin(), backward.all.end());
  EXPECT_TRUE(forward.mappedFromScratch(variant, wide) ==
              backward.mappedFromScratch(variant, wide));
  EXPECT_FALSE(forward.mappedFromScratch(variant) == backward.mappedFromScratch(variant));
}

TEST(KeyframeMap, makesAnewOnlyTilesInWhichAScanSeesSomethingElse) {
  std::mt19937 random(3);
  SemanticOcTree map = emptyMap({"hard"});
  KeyframeMap keyframes(map);
  for (int i = 0; i < 3; ++i) {
    const KeyframeId id = keyframes.begin(Eigen::Isometry3d(Eigen::Translation3d(20 * i, 0, 0)));
    ASSERT_EQ(id, std::size_t(i));
    keyframes.insert(randomScan(random).cloud, Eigen::Isometry3d::Identity());
  }
  const CorrectionReport same = keyframes.move({{1, keyframes.pose(1)}});
  EXPECT_EQ(same.scansTraced, 0u);
  EXPECT_EQ(same.tiles, 0u);
  const CorrectionReport one =
      keyframes.move({{1, Eigen::Isometry3d(Eigen::Translation3d(20.2, 0, 0))}});
  EXPECT_EQ(one.scansTraced, 1u);
  EXPECT_EQ(one.scansMerged, 1u) << "the others are too far away to share a tile";
  EXPECT_GT(one.tiles, 10u);
  const SemanticOcTree before = map;
  keyframes.remove(0);
  EXPECT_LT(map.size(), before.size());
}

TEST(KeyframeMap, correctsTilesThatScansShareAtTheirFarthest) {
  const Variant variant{"row"};
  std::mt19937 random(8);
  SemanticOcTree map = emptyMap(variant);
  KeyframeMap keyframes(map);
  Scans scans;
  RandomScanOptions options;
  options.sensorSpread = 0;
  double x = 0;  // beams reach 6 m, tiles are of 3.2 m
  for (KeyframeId id = 0; id < 30; ++id, x += between(random, 11, 15)) {
    scans.poses.push_back(Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)));
    scans.all.push_back({id, randomScan(random, options), 0});
    keyframes.begin(scans.poses[id]);
    keyframes.insert(scans.all[id].scan.cloud, scans.all[id].scan.T_map_sensor, optionsOf(variant));
  }
  for (KeyframeId id = 0; id < 30; ++id) {
    scans.poses[id].translation() += randomPose(random, 0.5).translation();
    keyframes.move({{id, scans.poses[id]}});
    ASSERT_TRUE(map == scans.mappedFromScratch(variant)) << id;
  }
}

/** Nothing else changes that would lead the eye there. */
TEST(KeyframeMap, tellsOfABlockThatIsNotWorthItsPriceAnyMore) {
  Variant variant{"alone"};
  variant.blockSize = 1.6;
  SemanticOcTree map = emptyMap(variant);
  KeyframeMap keyframes(map);
  const auto insert = [&](float place, semantic_types::ClassId id) {
    LabeledCloud cloud;
    cloud.points = {{place, place, place}};
    cloud.classes = {id};
    keyframes.begin(Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.1, 0.1)));
    keyframes.insert(cloud, Eigen::Isometry3d::Identity());
  };
  insert(0.9f, 2);
  insert(0.5f, 1);
  Abstraction(map).takeChange();
  const std::size_t before = Abstraction(map).leaves().size();
  keyframes.remove(1);
  EXPECT_LT(Abstraction(map).leaves().size(), before);
  EXPECT_FALSE(Abstraction(map).takeChange().removed.empty());
}

TEST(KeyframeMap, refusesWhatIsNotThereAndStaysAsItWas) {
  std::mt19937 random(3);
  SemanticOcTree map = emptyMap({"hard"});
  KeyframeMap keyframes(map);
  const PosedCloud scan = randomScan(random);
  EXPECT_THROW(keyframes.insert(scan.cloud, scan.T_map_sensor), std::logic_error);
  keyframes.begin(Eigen::Isometry3d::Identity());
  keyframes.insert(scan.cloud, scan.T_map_sensor);
  const SemanticOcTree before = map;
  const Eigen::Isometry3d outside(Eigen::Translation3d(1e6, 0, 0));
  EXPECT_TRUE(contains(errorOf([&] { keyframes.remove(1); }), "no keyframe 1"));
  EXPECT_TRUE(contains(errorOf([&] { keyframes.move({{2, outside}}); }), "no keyframe 2"));
  EXPECT_THROW(keyframes.move({{0, outside}}), std::out_of_range);
  EXPECT_THROW(keyframes.insert(scan.cloud, outside), std::out_of_range);
  EXPECT_EQ(keyframes.numScans(), 1u);
  EXPECT_TRUE(keyframes.pose(0).isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(map == before);
  keyframes.remove(0);
  EXPECT_TRUE(map.empty());
  EXPECT_THROW(keyframes.insert(scan.cloud, scan.T_map_sensor), std::logic_error);
  EXPECT_THROW(keyframes.remove(0), std::out_of_range);
  SemanticOcTree full = before;
  EXPECT_THROW(KeyframeMap other(full), std::invalid_argument);
}

TEST(KeyframeMap, keepsItsScansWhereItIsToldTo) {
  std::mt19937 random(3);
  const PosedCloud scan = randomScan(random);
  const TemporaryFolder folder;
  SemanticOcTree a = emptyMap({"hard"}), b = a;
  {
    KeyframeMap inMemory(a), onDisk(b, folder.path());
    for (KeyframeMap* keyframes : {&inMemory, &onDisk}) {
      keyframes->begin(Eigen::Isometry3d::Identity());
      keyframes->insert(scan.cloud, scan.T_map_sensor);
    }
    EXPECT_GT(inMemory.bytes().inMemory, 13 * scan.cloud.size());
    EXPECT_EQ(inMemory.bytes().onDisk, 0u);
    EXPECT_LT(onDisk.bytes().inMemory, 1000u);
    EXPECT_GT(onDisk.bytes().onDisk, 13 * scan.cloud.size());
    EXPECT_FALSE(std::filesystem::is_empty(folder.path()));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}
