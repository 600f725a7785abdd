#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>

#include <algorithm>

#include "FollowedTree.h"
#include "OctreeAsTree.h"
#include "SmallScans.h"
#include "ThreeTerms.h"

namespace {

using namespace semantic_octree;

constexpr int kRegionClasses = 6;
constexpr double kRegionResolution = 0.2, kAround = 2, kCorridor = 1.2;

/** A way over the small place, and where the robot is on it at each scan. */
const std::vector<Eigen::Vector3d> kWay = {{-5, -4, 0}, {-1, -2, 0.1}, {2, 2, 0}, {5, 3, 0.2}};
Eigen::Vector3d robotAt(int scan) { return {-5 + 0.37 * scan, -4 + 0.21 * scan, 0}; }

/** Nothing counts but what is around the robot and along the stretches of its way from one on. */
std::vector<Region> regionsOf(int scan) {
  const Eigen::Vector3d far = Eigen::Vector3d::Constant(1000);
  std::vector<Region> regions = {
      {Region::Shape::Box, -far, far, 0, 0},
      {Region::Shape::Sphere, robotAt(scan), Eigen::Vector3d::Zero(), kAround, 1}};
  for (std::size_t i = scan / 4; i + 1 < kWay.size(); ++i)
    regions.push_back({Region::Shape::Corridor, kWay[i], kWay[i + 1], kCorridor, 1});
  return regions;
}

/** A place counts within a ball around the robot or a bend, or beside a stretch. */
double densityAt(const Eigen::Vector3d& place, int scan) {
  if ((place - robotAt(scan)).norm() <= kAround) return 1;
  for (std::size_t i = scan / 4; i + 1 < kWay.size(); ++i) {
    const Eigen::Vector3d along = kWay[i + 1] - kWay[i], off = place - kWay[i];
    const double s = off.dot(along.normalized());
    if (s >= 0 && s <= along.norm() && off.cross(along).norm() <= kCorridor * along.norm())
      return 1;
    if (std::min(off.norm(), (place - kWay[i + 1]).norm()) <= kCorridor) return 1;
  }
  return 0;
}

AbstractionOptions optionsOf(int scan, double alpha) {
  AbstractionOptions options = threeTerms(alpha, kRegionClasses, 0.05);
  options.regions = regionsOf(scan);
  return options;
}

void insert(SemanticOcTree& map, const PosedCloud& scan) {
  InsertionOptions options;
  options.maxRange = 9;
  map.insert(scan.cloud, scan.T_map_sensor, options);
}

TEST(MovingRegions, leaveGValuesAndLeavesOfAMapThatHadThemFromTheStartToTheLastBit) {
  const auto scans = scansOfSmallPlace(9, 2000, kRegionClasses, 4);
  SemanticOcTree moved(kRegionResolution, numberedClasses(kRegionClasses));
  setAbstraction(moved, threeTerms(0.002, kRegionClasses, 0.05));
  FollowedTree kept(moved);
  for (int i = 0; i < static_cast<int>(scans.size()); ++i) {
    Abstraction(moved).setRegions(regionsOf(i));
    insert(moved, scans[i]);
    SemanticOcTree fresh(kRegionResolution, numberedClasses(kRegionClasses));
    setAbstraction(fresh, optionsOf(i, 0.002));
    for (int j = 0; j <= i; ++j) insert(fresh, scans[j]);
    ASSERT_TRUE(moved == fresh) << i;
    kept.follow();  // its leaves are those of `fresh`, as the maps are equal
    ASSERT_FALSE(HasFailure()) << i;
  }
  EXPECT_GT(kept.size(), 100u);
}

TEST(MovingRegions, leaveTheTreeOfThePlainSearchWithTheDensityOfEachVoxel) {
  const auto scans = scansOfSmallPlace(9, 2000, kRegionClasses, 4);
  for (const double alpha : {0.0, 0.002, 0.02}) {
    SemanticOcTree map(kRegionResolution, numberedClasses(kRegionClasses));
    setAbstraction(map, optionsOf(0, alpha));
    for (const PosedCloud& scan : scans) insert(map, scan);
    for (const int at : {2, 5, 8}) {
      Abstraction(map).setRegions(regionsOf(at));
      const int blockDepth = 12;  // 3.2 m
      const OctreeAsTree plain(map, blockDepth, blockDepth,
                               [at](const Eigen::Vector3d& place) { return densityAt(place, at); });
      const std::set<LeafId> expected = plain.knownAmong(
          reference::findOptimalTree(plain.forest, optionsOf(at, alpha).weights).leaves());
      EXPECT_EQ(idsOf(Abstraction(map).leaves()), expected) << "alpha " << alpha << " at " << at;
      EXPECT_GT(expected.size(), 50u);
    }
  }
}

}  // namespace

TEST(Regions, haveFiniteCornersWhereTheyHaveThem) {
  const Eigen::Vector3d none = Eigen::Vector3d::Constant(NAN), some(1, 2, 3);
  for (const auto shape : {Region::Shape::Box, Region::Shape::Sphere, Region::Shape::Corridor}) {
    const bool hasTwo = shape != Region::Shape::Sphere;
    EXPECT_THROW((Region{shape, none, some, 1, 1}.validate()), std::invalid_argument);
    const Region region{shape, some, none, 1, 1};
    if (hasTwo)
      EXPECT_THROW(region.validate(), std::invalid_argument);
    else
      EXPECT_NO_THROW(region.validate());
  }
}
