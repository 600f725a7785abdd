#include "ExploreTrial.h"

#include <gtest/gtest.h>

#include "KnownShare.h"
#include "Plain.h"

using namespace drive_study;
using semantic_types::ClassId;

namespace {

/** Sees 8 m with a small camera, and knows what pixels without a return say. */
simulated_drive::DriveConfig lookingAround(double budget) {
  auto config = smallConfig();
  config.sensors.hasCamera = true, config.sensors.hasLidar = false;
  config.sensors.emptyCarves = true;
  config.sensors.camera.width = 96, config.sensors.camera.height = 72;
  config.insertion.maxRange = 8;
  config.explore.sensor = {8, -45, 15, 80};
  config.explore.sensorHeight = 1.2;
  config.explore.budget = budget;
  return config;
}

ExploreTask lookingFor(const std::set<int>& classes, const std::set<ClassId>& ground) {
  ExploreTask task;
  task.weights.terms = {
      tree_abstraction::relevant("it", 1, std::vector<int>(classes.begin(), classes.end()))};
  task.classes = ground;
  task.within = 20;
  return task;
}

const std::set<int> kStreets{synthetic_world::kRoad, synthetic_world::kLaneMarking},
    kLawns{synthetic_world::kGrass};

}  // namespace

TEST(ExploreTrial, endsByItselfWithNearlyAllThatMoreMetersFind) {
  const auto scene = synthetic_world::makeScene("village", 71);
  const ExploreTask task = lookingFor(kStreets, {kStreets.begin(), kStreets.end()});
  auto config = lookingAround(400);
  const mrpt::math::TPose2D start(scene.route.at(0).x(), scene.route.at(0).y(), 0);
  const auto byItself = explore(config, scene, syntheticOrder(), task, start, Exploring::Relevant);
  config.explore.leftShare = 1e-9;
  const auto toTheEnd = explore(config, scene, syntheticOrder(), task, start, Exploring::Relevant);
  EXPECT_LT(byItself.meters(), toTheEnd.meters());
  EXPECT_GE(byItself.share(), 0.95 * toTheEnd.share());
  EXPECT_NE(byItself.end.find("% of the relevant information within reach is known"),
            std::string::npos)
      << byItself.end;
}

/** Three villages are summed up: a single short drive may have bad luck. */
TEST(ExploreTrial, ofOtherWeightsDrivesElsewhereAndWinsThere) {
  const auto config = lookingAround(60);
  const auto shareOf = [&](const std::set<int>& weights, const std::set<int>& ground) {
    const ExploreTask task = lookingFor(weights, {ground.begin(), ground.end()});
    double sum = 0;
    for (const std::uint64_t seed : {72, 73, 74}) {
      const auto scene = synthetic_world::makeScene("village", seed);
      const mrpt::math::TPose2D start(scene.route.at(0).x(), scene.route.at(0).y(), 0);
      sum += explore(config, scene, syntheticOrder(), task, start, Exploring::Relevant).share();
    }
    return sum;
  };
  EXPECT_GT(shareOf(kStreets, kStreets), 1.5 * shareOf(kLawns, kStreets));
  EXPECT_GT(shareOf(kLawns, kLawns), 1.5 * shareOf(kStreets, kLawns));
}

namespace {

/** A car along x and a person, on grass beside a road. */
struct CarAndPerson {
  const synthetic_world::World world = [] {
    auto things = synthetic_world::car({5, 8, 0}, 0, {});
    const auto person = synthetic_world::person({-8, 8, 0}, 0, {});
    things.insert(things.end(), person.begin(), person.end());
    return plain(things);
  }();
  semantic_octree::SemanticOcTree map{0.2, synthetic_world::classTable()};

  /** Voxels of one class, as often as they are to be believed. */
  void insert(ClassId id, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    semantic_types::LabeledCloud cloud;
    for (double x = low.x(); x < high.x(); x += 0.1)
      for (double y = low.y(); y < high.y(); y += 0.1)
        for (double z = low.z(); z < high.z(); z += 0.1) {
          cloud.points.emplace_back(x, y, z);
          cloud.classes.push_back(id);
        }
    semantic_octree::InsertionOptions asItIs;
    asItIs.carvingMargin = 100;
    for (int i = 0; i < 3; ++i) map.insert(cloud, Eigen::Isometry3d::Identity(), asItIs);
  }
};

}  // namespace

TEST(KnownShare, knowsACarByOneOfItsSides) {
  CarAndPerson s;
  KnownShare known(s.map, s.world,
                   lookingFor({}, {synthetic_world::kCar, synthetic_world::kPerson}));
  EXPECT_EQ(known.share(), 0);
  s.insert(synthetic_world::kCar, {2.9, 6.9, 0.35}, {3.3, 7.5, 1.2});  // a corner
  EXPECT_EQ(known.share(), 0);
  s.insert(synthetic_world::kPerson, {2.9, 6.9, 0.35}, {7.1, 7.5, 1.2});  // a wrong class
  EXPECT_EQ(known.share(), 0);
  for (int i = 0; i < 4; ++i) s.insert(synthetic_world::kCar, {2.9, 6.9, 0.35}, {7.1, 7.5, 1.2});
  EXPECT_EQ(known.share(), 0.5);
  const long side = known.columns();
  s.insert(synthetic_world::kCar, {2.9, 8.5, 0.35}, {7.1, 9.1, 1.2});
  EXPECT_EQ(known.share(), 0.5);
  EXPECT_GT(known.columns(), 3 * side / 2);
}

TEST(KnownShare, isTheMeanOfGroundAndThingsIfBothAreLookedFor) {
  CarAndPerson s;
  KnownShare known(s.map, s.world, lookingFor({}, {synthetic_world::kRoad, synthetic_world::kCar}));
  s.insert(synthetic_world::kCar, {2.9, 6.9, 0.35}, {7.1, 7.5, 1.2});
  EXPECT_EQ(known.share(), 0.5);
  s.insert(synthetic_world::kRoad, {-19, -5, -0.05}, {0, 5, 0});
  EXPECT_NEAR(known.share(), 0.75, 0.01);
}
