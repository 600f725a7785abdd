#include <gtest/gtest.h>
#include <view_information/GainField.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "ThreeClasses.h"

using namespace view_information;
using semantic_octree::SemanticOcTree;
using semantic_types::LabeledCloud;

namespace {

/** Returns of a floor at z = 0 around the origin, the sensor 1 m above it. */
void insertFloor(SemanticOcTree& map, ClassId id, double reach = 2, double turn = 0) {
  LabeledCloud cloud;
  for (double x = -reach; x < reach; x += 0.1)
    for (double y = -reach; y < reach; y += 0.1) {
      cloud.points.emplace_back(x, y, -1.05F);
      cloud.classes.push_back(id);
    }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << turn, 0, 1;
  map.insert(cloud, T);
}

struct Scene {
  SemanticOcTree map{kVoxel, threeClasses()};
  Question question{relevantOnly(kRoad), 3};
  BeamModel model{3, map.filterParameters()};
  GainField field{map, question};
  UniformPrior prior{question, model};
};

/** Through which voxel of the shell before each voxel of a template is seen: the last one. */
std::vector<int> parentsOf(const ViewTemplate& view) {
  std::vector<int> parents, lastOf(static_cast<std::size_t>(view.reach()) + 1, -1);
  for (const ViewTemplate::Voxel& v : view.voxels()) {
    parents.push_back(v.shell > 0 ? lastOf[v.shell - 1U] : -1);
    lastOf[v.shell] = static_cast<int>(parents.size()) - 1;
  }
  return parents;
}

octomap::OcTreeKey keyAt(const SemanticOcTree& map, double x, double y, double z) {
  return map.coordToKey(x, y, z);
}

}  // namespace

TEST(GainField, hasOfEachVoxelWhatTheFilterMakesOfALook) {
  Scene s;
  insertFloor(s.map, kRoad);
  s.field.update();
  const semantic_octree::ClassFilter filter(3, s.map.filterParameters());
  std::size_t voxels = 0;
  for (auto leaf = s.map.begin_leafs(); leaf != s.map.end_leafs(); ++leaf) {
    const auto gain = s.field.at(leaf.getKey());
    ASSERT_TRUE(gain);
    const double fall = s.question.fallThrough(filter, s.model, s.map.belief(*leaf));
    EXPECT_NEAR(gain->gain, std::max(0.0, fall), 0.004 * std::abs(fall) + 1e-9);
    EXPECT_NEAR(gain->pass,
                passThrough(leaf->getOccupancy(), s.map.filterParameters().minOccupancy), 1e-4);
    ++voxels;
  }
  EXPECT_GT(voxels, 500U);
  EXPECT_FALSE(s.field.at(keyAt(s.map, 0, 0, -3)));
}

TEST(GainField, thatFollowsIsTheSameAsANewOne) {
  Scene s;
  for (int i = 0; i < 4; ++i) {
    insertFloor(s.map, i % 2 ? kRoad : kGrass, 1.5, i * 0.7);
    s.field.update();
  }
  EXPECT_TRUE(s.field.update().tiles.empty());
  GainField anew(s.map, s.question);
  anew.update();
  EXPECT_EQ(s.field.numTiles(), anew.numTiles());
  for (auto leaf = s.map.begin_leafs(); leaf != s.map.end_leafs(); ++leaf) {
    const auto a = s.field.at(leaf.getKey()), b = anew.at(leaf.getKey());
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->gain, b->gain);
    EXPECT_EQ(a->pass, b->pass);
  }
}

TEST(GainField, isEmptyAfterTheMapIs) {
  Scene s;
  insertFloor(s.map, kRoad);
  s.field.update();
  s.map.clear();
  EXPECT_TRUE(s.field.update().all);
  EXPECT_EQ(s.field.numTiles(), 0U);
}

TEST(GainField, sweepIsTheTreeOfItsVoxels) {
  Scene s;
  insertFloor(s.map, kRoad);
  s.field.update();
  const ViewTemplate view({3, -60, 20, 360}, kVoxel);
  const auto from = keyAt(s.map, 0.5, 0.3, 1);
  const SectorGains gains = s.field.sweep(view, s.prior, from);
  std::vector<TreeCell> cells;
  std::vector<std::vector<double>> beliefs;
  std::vector<double> reached, counts, left{1};
  const std::vector<int> parents = parentsOf(view);
  for (const ViewTemplate::Voxel& v : view.voxels()) {
    const octomap::OcTreeKey key =
        semantic_octree::octomapKey(from[0] + v.x, from[1] + v.y, from[2] + v.z);
    const Gain unknown = s.prior.patch(0, 0).at(key[0], key[1], key[2]);
    const Gain gain = s.field.at(key).value_or(unknown);
    if (!cells.empty()) {
      const double here = left[static_cast<std::size_t>(parents[cells.size()])];
      left.push_back(here * static_cast<double>(gain.pass));
      reached.push_back(here);
      counts.push_back(static_cast<double>(view.weight(v)));
      beliefs.push_back(nothingKnown(3));
      if (const auto leaf = s.map.search(key))
        s.map.belief(leaf).distribution(3, beliefs.back().data());
    }
    cells.push_back(cells.empty() ? TreeCell{-1, 1, 0}
                                  : TreeCell{parents[cells.size()], gain.pass,
                                             static_cast<double>(view.weight(v) * gain.gain)});
  }
  const double tree = informationOfTree(cells);
  EXPECT_GT(tree, 1);
  EXPECT_NEAR(gainOfHeading(gains, 0, 360), tree, 0.01 * tree);
  // What it adds to the compressed tree; beams end where they hardly reach anything.
  const Bounds growth = s.field.growth(view, s.prior, from, 0),
               all = growthOfTree(s.question, s.model, beliefs, reached, counts);
  const double n = std::accumulate(counts.begin(), counts.end(), 0.0);
  EXPECT_GT(growth.upper, 1);
  EXPECT_NEAR(growth.upper, n * all.upper, 0.01 * n * all.upper);
  EXPECT_NEAR(growth.lower, n * all.lower, 0.01 * n * all.upper);
  const ViewTemplate narrow({3, -60, 20, 90}, kVoxel);
  double ofQuarters = 0;
  for (const int sector : {4, 13, 22, 31})
    ofQuarters += s.field.growth(narrow, s.prior, from, sector).upper;
  EXPECT_NEAR(ofQuarters, growth.upper, 1e-9 * growth.upper);
}

/** A view's beams stand for all voxels between its elevations. */
TEST(GainField, sweepOfAFarViewIsNearTheMeanOfManyStraightBeams) {
  Scene s;
  insertFloor(s.map, kRoad, 9);
  s.field.update();
  constexpr double kLow = -60, kHigh = 5, kFar = 10 / kVoxel;  // degrees, voxels
  const ViewTemplate view({10, kLow, kHigh, 360}, kVoxel);
  const auto from = keyAt(s.map, 0.5, 0.3, 1);
  const auto shells = static_cast<std::size_t>(view.reach()) + 1;
  std::vector<double> seen(shells, 0), beams(shells, 0), voxels(shells, 0);
  for (double up = kLow; up <= kHigh; up += 0.5)
    for (double around = 0; around < 360; around += 1) {
      const double flat = std::cos(up * M_PI / 180);
      const std::array<double, 3> d{flat * std::cos(around * M_PI / 180),
                                    flat * std::sin(around * M_PI / 180),
                                    std::sin(up * M_PI / 180)};
      const double largest = std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
      double reached = 1;
      for (std::size_t shell = 1; static_cast<double>(shell) <= kFar * largest; ++shell) {
        std::array<int, 3> key{};
        for (std::size_t a = 0; a < 3; ++a)
          key[a] =
              from[a] + static_cast<int>(std::lround(static_cast<double>(shell) * d[a] / largest));
        const Gain gain = s.field.at(semantic_octree::octomapKey(key[0], key[1], key[2]))
                              .value_or(s.prior.patch(0, 0).at(key[0], key[1], key[2]));
        seen[shell] += reached * static_cast<double>(gain.gain), ++beams[shell];
        reached *= static_cast<double>(gain.pass);
      }
    }
  for (const auto& v : view.voxels()) voxels[v.shell] += static_cast<double>(view.weight(v));
  double all = 0, count = 0;
  for (std::size_t shell = 1; shell < shells; ++shell) {
    if (beams[shell] > 0) all += voxels[shell] * seen[shell] / beams[shell];
    count += voxels[shell];
  }
  EXPECT_NEAR(gainOfHeading(s.field.sweep(view, s.prior, from), 0, 360), all, 0.15 * all);
  const double sphere = 4.0 / 3 * M_PI * std::pow(kFar, 3);
  const double share = (std::sin(kHigh * M_PI / 180) - std::sin(kLow * M_PI / 180)) / 2;
  EXPECT_NEAR(count, share * sphere, 0.05 * share * sphere);
}

namespace {

/** Ground of one voxel's height that is worth a nat wherever it is not known, and air. */
class FlatGround : public UnknownPrior {
 public:
  explicit FlatGround(int ground) {
    m_patch.ground = ground, m_patch.top = ground + 10;
    m_patch.onGround = {0.05F, 1}, m_patch.above = {1, 0};
  }
  const UnknownPatch& patch(int, int) override { return m_patch; }
  bool knowsAir() const override { return true; }

 private:
  UnknownPatch m_patch;
};

}  // namespace

/** At 10 m a beam is a voxel above the ground for 8 voxels before it meets it. */
TEST(GainField, sweepSeesFlatGroundBehindTheGroundThatIsKnown) {
  Scene s;
  for (int i = 0; i < 12; ++i) insertFloor(s.map, kRoad, 5);
  s.field.update();
  FlatGround ground(keyAt(s.map, 0, 0, -0.05)[2]);
  const ViewTemplate view({10, -45, 15, 360}, kVoxel);
  const double promise =
      gainOfHeading(s.field.sweep(view, ground, keyAt(s.map, 0, 0, 1.25)), 0, 360);
  // Beams between those that end at 5 and at 10 m, each for the voxels around it.
  const double degrees = (std::atan(1.2 / 5) - std::atan(1.2 / 10)) * 180 / M_PI;
  EXPECT_GT(promise, degrees / 2 * 72);
}

TEST(GainField, airThatWasSeenOnceIsNoDenserForBeams) {
  const auto toldBehind = [](int looks) {
    Scene s;
    for (int i = 0; i < looks; ++i) insertFloor(s.map, kRoad, 5);
    s.field.update();
    FlatGround ground(keyAt(s.map, 0, 0, -0.05)[2]);
    const ViewTemplate ring({10, -9, -9, 360, 1, 36}, kVoxel);
    return gainOfHeading(s.field.sweep(ring, ground, keyAt(s.map, 0, 0, 0.85)), 0, 360);
  };
  const double often = toldBehind(12);
  EXPECT_GT(often, 18);
  EXPECT_NEAR(toldBehind(1), often, 0.05 * often);
}

TEST(GainField, knowsAsMuchAsTheOccupiedVoxelsTell) {
  Scene s;
  EXPECT_EQ(s.field.known(), 0);
  double before = 0;
  for (const ClassId id : {kGrass, kRoad, kRoad}) {
    insertFloor(s.map, id, 1.5);
    s.field.update();
    double sum = 0;
    const auto nothing = nothingKnown(3);
    for (auto leaf = s.map.begin_leafs(); leaf != s.map.end_leafs(); ++leaf) {
      std::vector<double> p(4);
      s.map.belief(*leaf).distribution(3, p.data());
      const int edge = semantic_octree::edgeAtDepth(static_cast<int>(leaf.getDepth()));
      if (s.map.isNodeOccupied(*leaf))
        sum += edge * edge * edge * s.question.divergence(p.data(), nothing.data());
    }
    EXPECT_NEAR(s.field.known(), sum, 1e-4 * sum);
    EXPECT_GT(std::abs(sum - before), 1);
    before = sum;
  }
  s.map.clear();
  s.field.update();
  EXPECT_EQ(s.field.known(), 0);
}

/** A beam that grazes the ground returns from a voxel that the next one passes. */
TEST(GainField, promisesNothingOfWhatBeamsPassedForWhoKnowsAir) {
  Scene s;
  insertFloor(s.map, kRoad);
  LabeledCloud below;
  below.points.emplace_back(0.05F, 0.05F, -1.35F);
  below.classes.push_back(kRoad);
  const octomap::OcTreeKey key = keyAt(s.map, 0.05, 0.05, -0.05);
  while (s.map.query(key).occupancy >= 0.5)
    s.map.insert(below, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1)));
  ASSERT_TRUE(s.map.search(key).hasClassRecord());
  s.field.update();
  EXPECT_GT(s.field.at(key)->gain, 0.1);
  FlatGround ground(key[2] - 3);
  const ViewTemplate straight({1.3, -90, -89, 360}, kVoxel);
  const SectorGains gains = s.field.sweep(straight, ground, keyAt(s.map, 0.05, 0.05, 1.05));
  EXPECT_EQ(gainOfHeading(gains, 0, 360), 0);
}

TEST(GainField, keepsTilesThatAreTheSameThroughoutOnce) {
  Scene s;
  LabeledCloud cloud;
  for (int i = 0; i < 400; ++i)
    for (int j = 0; j < 100; ++j) {
      cloud.points.emplace_back(20, -10 + 0.05F * static_cast<float>(i),
                                -5 + 0.1F * static_cast<float>(j));
      cloud.classes.push_back(kWall);
    }
  for (int i = 0; i < 12; ++i) s.map.insert(cloud, Eigen::Isometry3d::Identity());
  s.field.update();
  EXPECT_LT(s.field.memoryUsage(), s.field.numTiles() * 4 * 512 * 9 / 10);
}

TEST(ViewTemplate, hasEachVoxelAfterTheOneThroughWhichItIsSeen) {
  const ViewTemplate view({4, -30, 10, 80}, kVoxel);
  const auto& voxels = view.voxels();
  ASSERT_GT(voxels.size(), 1000U);
  const std::vector<int> parents = parentsOf(view);
  for (std::size_t i = 1; i < voxels.size(); ++i) {
    const auto& v = voxels[i];
    ASSERT_EQ(v.shell, std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}));
    ASSERT_GE(parents[i], 0);
    ASSERT_LT(parents[i], static_cast<int>(i));
    const auto& p = voxels[static_cast<std::size_t>(parents[i])];
    ASSERT_LE(std::max({std::abs(v.x - p.x), std::abs(v.y - p.y), std::abs(v.z - p.z)}), 1);
  }
  EXPECT_THROW(ViewTemplate({4, 20, 10, 80}, kVoxel), std::invalid_argument);
  EXPECT_THROW(ViewTemplate({std::nan(""), -20, 10, 80}, kVoxel), std::invalid_argument);
}
