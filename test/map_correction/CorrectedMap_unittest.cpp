// Maps of keyframes that come, move and go, against mapping from scratch.
#include <gtest/gtest.h>
#include <semantic_octree/MapFollower.h>

#include <algorithm>
#include <set>

#include "FollowedTree.h"
#include "KeyframeScans.h"
#include "Voxels.h"

using namespace keyframe_scans;

namespace {

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
    const std::set<KeyframeId> some{any(), any()};
    m_map.remove(some);
    for (const KeyframeId id : some) {
      scans.removeOf(id);
      m_present.erase(std::find(m_present.begin(), m_present.end(), id));
    }
  }
  KeyframeId any() { return m_present[m_random() % m_present.size()]; }

  std::mt19937 m_random;
  const Variant& m_variant;
  KeyframeMap& m_map;
  std::vector<KeyframeId> m_present;
};

class CorrectedMap : public testing::TestWithParam<Variant> {};

}  // namespace

TEST_P(CorrectedMap, isWhatMappingFromScratchMakesAfterAnyInsertionsMovesAndRemovals) {
  const Variant& variant = GetParam();
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SemanticOcTree map = emptyMap(variant);
    KeyframeMap keyframes(map);
    RandomWork work(seed, variant, keyframes);
    for (int i = 0; i < 14; ++i) {
      work.step();
      map.age(0.1);
      work.scans.now += 100;
      const SemanticOcTree expected = work.scans.mappedFromScratch(variant);
      ASSERT_TRUE(map == expected) << variant.name << ", seed " << seed << ", step " << i;
      EXPECT_EQ(map.size(), expected.size());
      EXPECT_EQ(map.memoryUsage(), expected.memoryUsage());
      EXPECT_EQ(keyframes.numScans(), work.scans.all.size());
    }
  }
}

TEST_P(CorrectedMap, tellsItsChangesAsAMapThatGrowsDoes) {
  const Variant& variant = GetParam();
  SemanticOcTree map = emptyMap(variant);
  KeyframeMap keyframes(map);
  MapFollower follower = map.follow();
  follower.skipTiles();
  FollowedTree told(map), often(map);
  RandomWork work(7, variant, keyframes);
  for (int i = 0; i < 40; ++i) {
    const SemanticOcTree before = map;
    work.step();
    if (map == before) continue;
    const auto touched = asSet(follower.tiles().tiles), differ = tilesThatDiffer(before, map);
    EXPECT_TRUE(std::includes(touched.begin(), touched.end(), differ.begin(), differ.end()));
    often.follow();
    if (i % 2) continue;  // changes add up
    told.follow();
    ASSERT_FALSE(HasFailure()) << "step " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Variants, CorrectedMap,
    testing::Values(Variant{"hard"}, Variant{"soft", true}, Variant{"unpruned", false, false},
                    Variant{"threads", true, true, 2},
                    Variant{"chargedFrame", false, true, 1, AbstractionOptions::Frame::Charged},
                    Variant{"endVoxels", false, true, 1, AbstractionOptions::Frame::Free,
                            InsertionOptions::Rays::EndVoxels},
                    Variant{"ages", true, true, 2, AbstractionOptions::Frame::Free,
                            InsertionOptions::Rays::All, true},
                    Variant{"coarse", false, true, 1, AbstractionOptions::Frame::Free,
                            InsertionOptions::Rays::All, true, 0.15, 1.6}),
    [](const auto& variant) { return variant.param.name; });
