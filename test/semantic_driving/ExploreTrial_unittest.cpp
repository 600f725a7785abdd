#include "ExploreTrial.h"

#include <gtest/gtest.h>

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
  EXPECT_NE(byItself.end.find("% of the relevant information is known"), std::string::npos)
      << byItself.end;
}

TEST(ExploreTrial, ofOtherWeightsDrivesElsewhereAndWinsThere) {
  const auto scene = synthetic_world::makeScene("village", 72);
  const auto config = lookingAround(60);
  const mrpt::math::TPose2D start(scene.route.at(0).x(), scene.route.at(0).y(), 0);
  const auto shareOf = [&](const std::set<int>& weights, const std::set<int>& ground) {
    const ExploreTask task = lookingFor(weights, {ground.begin(), ground.end()});
    return explore(config, scene, syntheticOrder(), task, start, Exploring::Relevant).share();
  };
  EXPECT_GT(shareOf(kStreets, kStreets), 1.1 * shareOf(kLawns, kStreets));
  EXPECT_GT(shareOf(kLawns, kLawns), 1.1 * shareOf(kStreets, kLawns));
}
