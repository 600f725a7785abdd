#include <gtest/gtest.h>
#include <map_operations/MapOperations.h>
#include <octomap/OcTree.h>

#include <algorithm>

#include "Voxels.h"

using namespace semantic_octree;

namespace {

constexpr double kMergedResolution = 0.4;

/** Limits that ten scans do not reach. */
FilterParameters laxLimits() {
  FilterParameters p;
  p.minOccupancy = 1e-9;
  p.maxProbability = 1 - 1e-9;
  return p;
}

std::vector<PosedCloud> scans(int n, int classes) {
  std::mt19937 random(7);
  RandomScanOptions options;
  options.classes = classes;
  std::vector<PosedCloud> result;
  for (int i = 0; i < n; ++i) result.push_back(randomScan(random, options));
  return result;
}

SemanticOcTree mapOf(const std::vector<PosedCloud>& scans, int classes,
                     const FilterParameters& filter = {}) {
  SemanticOcTree map(kMergedResolution, numberedClasses(classes), filter);
  for (const PosedCloud& scan : scans) map.insert(scan.cloud, scan.T_map_sensor);
  return map;
}

std::vector<SemanticOcTree> mapsOfSingle(const std::vector<PosedCloud>& scans, int classes,
                                         const FilterParameters& filter = {}) {
  std::vector<SemanticOcTree> maps;
  for (const PosedCloud& scan : scans) maps.push_back(mapOf({scan}, classes, filter));
  return maps;
}

std::vector<const SemanticOcTree*> pointers(const std::vector<SemanticOcTree>& maps) {
  std::vector<const SemanticOcTree*> result;
  for (const SemanticOcTree& map : maps) result.push_back(&map);
  return result;
}

/** The known voxels of a group: the distributions of 3 classes and free space. */
struct Group {
  double highest = -HUGE_VAL;  ///< log-odds
  std::vector<std::vector<double>> members;
  std::vector<double> odds{0, 0, 0, 0};  ///< of classes, where labels were seen

  void add(double logOdds, const std::vector<double>& p, bool isLabeled) {
    highest = std::max(highest, logOdds);
    members.push_back(p);
    for (int k = 1; isLabeled && k <= 3; ++k) odds[k] += p[k];
  }
  bool areAlike(std::size_t number) const {
    return std::count(members.begin(), members.end(), members[0]) == std::ptrdiff_t(number);
  }
  /** As occupied as the most occupied, classes of the mixture; as a map stores log-odds. */
  std::vector<double> mixture() const {
    std::vector<double> p{1};
    const double occupied = odds[1] + odds[2] + odds[3];
    double sum = 1;
    for (int k = 1; k <= 3; ++k)
      sum += p.emplace_back(
          std::exp(stored(highest + std::log(occupied > 0 ? odds[k] / occupied : 1.0 / 3))));
    for (double& x : p) x /= sum;
    return p;
  }
};

}  // namespace

TEST(MergedMap, ofSingleScansIsTheMapOfAllToTheLastBitWhileNoLimitIsReached) {
  const auto some = scans(10, 3);
  const auto single = mapsOfSingle(some, 3, laxLimits());
  EXPECT_TRUE(merged(pointers(single)) == mapOf(some, 3, laxLimits()));
}

TEST(MergedMap, doesNotDependOnTheOrderOfTheMaps) {
  const auto single = mapsOfSingle(scans(10, 5), 5);
  auto order = pointers(single);
  const SemanticOcTree first = merged(order);
  std::mt19937 random(1);
  for (int i = 0; i < 5; ++i) {
    std::shuffle(order.begin(), order.end(), random);
    EXPECT_TRUE(merged(order) == first);
  }
}

TEST(MergedMap, doesNotDependOnTheGroupingOfUnlimitedSums) {
  const auto single = mapsOfSingle(scans(10, 3), 3);
  const auto all = pointers(single);
  const SemanticOcTree atOnce = merged(all);
  std::mt19937 random(2);
  for (int i = 0; i < 5; ++i) {
    std::vector<SemanticOcTree> parts = single;
    while (parts.size() > 2) {
      std::shuffle(parts.begin(), parts.end(), random);
      SemanticOcTree pair = merged({&parts[0], &parts[1]}, Limits::Keep);
      parts.erase(parts.begin(), parts.begin() + 2);
      parts.push_back(std::move(pair));
    }
    EXPECT_TRUE(merged(pointers(parts)) == atOnce);
  }
}

TEST(MergedMap, ofFourMapsThatAreAllAsSureAsCanBeMayBeGrouped) {
  const auto some = scans(3, 3);
  std::vector<PosedCloud> repeated;
  for (int i = 0; i < 12; ++i) repeated.insert(repeated.end(), some.begin(), some.end());
  const SemanticOcTree map = mapOf(repeated, 24), pair = merged({&map, &map}, Limits::Keep);
  EXPECT_TRUE(merged({&pair, &pair}) == merged({&map, &map, &map, &map}));
  EXPECT_FALSE(pair == merged({&map, &map}));
}

TEST(MergedMap, keepsWhichClassIsLikelierInSumsThatAreTooLarge) {
  LabeledCloud cloud;
  cloud.points.assign(7, {1, 1, 1});
  cloud.classes = {2, 2, 2, 2, 1, 1, 1};
  SemanticOcTree map(kMergedResolution, numberedClasses(3));
  map.insert(cloud, Eigen::Isometry3d::Identity());
  const SemanticOcTree sum = merged(std::vector<const SemanticOcTree*>(11, &map), Limits::Keep);
  const auto difference = [](const SemanticOcTree& of, ClassId id) {
    const auto belief = of.belief(of.search(of.coordToKey(1, 1, 1)));
    return belief.logOddsOf(2) - belief.logOddsOf(id);
  };
  EXPECT_EQ(sum.query(1, 1, 1).likeliestClass, 2);
  for (const ClassId other : {1, 3}) EXPECT_EQ(difference(sum, other), 11 * difference(map, other));
  EXPECT_EQ(sum.search(sum.coordToKey(1, 1, 1)).getLogOdds(), 32767 / 1024.f);
  EXPECT_GT(sum.search(sum.coordToKey(0, 0, 0)).getLogOdds(), -32);
}

TEST(MergedMap, ofOneMapIsThatMap) {
  const SemanticOcTree map = mapOf(scans(4, 5), 5);
  EXPECT_TRUE(merged({&map}) == map);
  const SemanticOcTree empty(kMergedResolution, numberedClasses(5));
  EXPECT_TRUE(merged({&map, &empty}) == map);
  EXPECT_TRUE(merged({&empty, &empty}).empty());
}

TEST(MergedMap, ofMapsThatDifferInKindIsRefused) {
  const SemanticOcTree map(0.4, numberedClasses(3)), finer(0.2, numberedClasses(3)),
      others(0.4, numberedClasses(4)), filtered(0.4, numberedClasses(3), laxLimits());
  for (const SemanticOcTree* other : {&finer, &others, &filtered})
    EXPECT_THROW(merged({&map, other}), std::invalid_argument);
  EXPECT_THROW(merged({}), std::invalid_argument);
}

TEST(CroppedMap, hasTheVoxelsWhoseCentersAreInTheBox) {
  const SemanticOcTree map = mapOf(scans(4, 5), 5);
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-3.1, -2, -1.5), Eigen::Vector3d(2.25, 4.4, 0.9));
  auto expected = voxelsOf(map);
  for (auto voxel = expected.begin(); voxel != expected.end();)
    voxel = box.contains(centerOf(voxel->first, kMergedResolution)) ? std::next(voxel)
                                                                    : expected.erase(voxel);
  ASSERT_GT(expected.size(), 100u);
  EXPECT_EQ(voxelsOf(cropped(map, box)), expected);
}

TEST(CroppedMap, isTheMapIfTheBoxHoldsAllAndEmptyIfItHoldsNothing) {
  const SemanticOcTree map = mapOf(scans(4, 5), 5);
  const Eigen::Vector3d far = Eigen::Vector3d::Constant(1e9), one = Eigen::Vector3d::Ones();
  EXPECT_TRUE(cropped(map, {-far, far}) == map);
  EXPECT_TRUE(cropped(map, {1000 * one, 1001 * one}).empty());
  EXPECT_THROW(cropped(map, {one, -one}), std::invalid_argument);
  EXPECT_THROW(cropped(map, {one * NAN, one}), std::invalid_argument);
}

TEST(CoarsenedMap, hasTheMostOccupiedVoxelAndTheMixtureOfEachGroup) {
  const SemanticOcTree map = mapOf(scans(4, 3), 3);
  for (const int levels : {1, 2}) {
    const SemanticOcTree coarse = coarsened(map, levels);
    EXPECT_EQ(coarse.getResolution(), kMergedResolution * (1 << levels));
    std::map<VoxelId, Group> groups;
    for (const auto& [id, p] : voxelsOf(map))
      groups[{id[0] >> levels, id[1] >> levels, id[2] >> levels}].add(
          map.search(keyOf(id)).getLogOdds(), p, map.search(keyOf(id)).hasClassRecord());
    const auto voxels = voxelsOf(coarse);
    ASSERT_EQ(voxels.size(), groups.size());
    for (const auto& [id, group] : groups) {
      ASSERT_TRUE(voxels.count(id));
      const std::size_t inGroup = std::size_t(1) << 3 * levels;
      const auto expected = group.areAlike(inGroup) ? group.members[0] : group.mixture();
      EXPECT_LT(totalVariation(voxels.at(id), expected), 1e-9);
    }
  }
}

TEST(CoarsenedMap, byNoLevelIsTheMap) {
  const SemanticOcTree map = mapOf(scans(4, 5), 5);
  EXPECT_TRUE(coarsened(map, 0) == map);
  EXPECT_THROW(coarsened(map, -1), std::invalid_argument);
  EXPECT_THROW(coarsened(map, 9), std::invalid_argument);
}

TEST(MovedMap, takesEachVoxelFromWhereItsCenterWas) {
  std::mt19937 random(11);
  const SemanticOcTree map = mapOf(scans(2, 5), 5);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Isometry3d there = randomPose(random, 5);
    std::map<VoxelId, std::vector<double>> expected;
    for (int x = -60; x < 60; ++x)
      for (int y = -60; y < 60; ++y)
        for (int z = -60; z < 60; ++z) {
          const VoxelId id{x, y, z};
          const Eigen::Vector3d p = there.inverse() * centerOf(id, kMergedResolution);
          octomap::OcTreeKey key;
          ASSERT_TRUE(map.coordToKeyChecked(octomap::point3d(p.x(), p.y(), p.z()), key));
          if (const auto node = map.search(key)) expected[id] = map.distribution(*node);
        }
    const auto voxels = voxelsOf(moved(map, there));
    std::size_t different = 0;  // OctoMap's points are floats: on borders they may fall elsewhere
    for (const auto& [id, p] : expected) different += !voxels.count(id) || voxels.at(id) != p;
    EXPECT_LE(different, expected.size() / 10000);
    EXPECT_NEAR(voxels.size(), expected.size(), expected.size() / 10000.0);
  }
}

TEST(MovedMap, refusesWhatIsNotAPoseOrLeadsOutside) {
  const SemanticOcTree map = mapOf(scans(1, 5), 5);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() *= 2;
  EXPECT_THROW(moved(map, T), std::invalid_argument);
  T = Eigen::Translation3d(1e5, 0, 0);
  EXPECT_THROW(moved(map, T), std::out_of_range);
  T = Eigen::Translation3d(NAN, 0, 0);
  EXPECT_THROW(moved(map, T), std::invalid_argument);
}

TEST(MovedMap, andCroppedRefuseToCutALeafOfATownIntoVoxels) {
  octomap::OcTree occupancy(kMergedResolution);
  occupancy.updateNode(octomap::point3d(-1, -1, -1), true);
  octomap::OcTreeNode* node = occupancy.getRoot();
  for (const unsigned child : {7, 0, 0}) node = occupancy.createNodeChild(node, child);
  node->setLogOdds(1);
  occupancy.updateInnerOccupancy();
  const SemanticOcTree map = fromOcTree(occupancy, numberedClasses(5), {});
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()));
  EXPECT_THROW(moved(map, turn), std::length_error);
  const auto part = [&](double x, double y, double z) {
    return cropped(map, {Eigen::Vector3d(-9, -9, -9), Eigen::Vector3d(x, y, z)});
  };
  EXPECT_THROW(part(1e4, 1e4, 1.1), std::length_error);
  EXPECT_GT(part(1e4, 1e4, 1638.5).size(), 8u);
}

TEST(ImportedOccupancy, isTheOccupancyWithinTheLimits) {
  octomap::OcTree occupancy(kMergedResolution);
  for (const PosedCloud& scan : scans(5, 5)) {
    octomap::Pointcloud points;
    for (const Eigen::Vector3f& p : scan.cloud.points) {
      const Eigen::Vector3f q = (scan.T_map_sensor * p.cast<double>()).cast<float>();
      if (q.allFinite()) points.push_back(q.x(), q.y(), q.z());
    }
    const Eigen::Vector3f o = scan.T_map_sensor.translation().cast<float>();
    occupancy.insertPointCloud(points, {o.x(), o.y(), o.z()});
  }
  FilterParameters filter;
  filter.minOccupancy = 0.3;
  const SemanticOcTree map = fromOcTree(occupancy, numberedClasses(5), filter);
  std::size_t voxels = 0;
  for (auto leaf = occupancy.begin_leafs(); leaf != occupancy.end_leafs(); ++leaf) {
    const double lowest = stored(logit(0.3)), highest = stored(logit(0.97)) + stored(std::log(5));
    const double within = std::min(highest, std::max<double>(lowest, leaf->getLogOdds()));
    EXPECT_NEAR(map.query(leaf.getKey()).occupancy, sigmoid(stored(within)), 1e-9);
    voxels += std::size_t(1) << 3 * (16 - leaf.getDepth());
  }
  EXPECT_EQ(voxelsOf(map).size(), voxels);
}
