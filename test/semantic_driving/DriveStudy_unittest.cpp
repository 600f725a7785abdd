#include <gtest/gtest.h>

#include "Plain.h"
#include "Trial.h"

using namespace drive_study;
using simulated_drive::DriveEnd;
using synthetic_world::World;

namespace {

/** Flat grass with a road, and a yard with walls all around. */
World withYard() {
  synthetic_world::Solids solids;
  addWall(solids, {6, -4}, {14, -4});
  addWall(solids, {14, -4}, {14, 4});
  addWall(solids, {14, 4}, {6, 4});
  addWall(solids, {6, 4}, {6, -4});
  return plain(solids);
}

Task solved(const World& world, const mrpt::math::TPose2D& start, const mrpt::math::TPose2D& goal) {
  const auto config = smallConfig();
  const auto order = syntheticOrder();
  Oracle oracle(world, order, config.planner, config.voxelSize);
  Task task;
  task.start = start;
  task.goal = goal;
  EXPECT_TRUE(oracle.accepts(task));
  oracle.solve(task);
  return task;
}

}  // namespace

TEST(DriveStudy, TheTrueMapHasTheGroundAndWhatStandsOnIt) {
  const World world = withYard();
  const auto map = trueMap(world, 0.2, 1.4);
  EXPECT_EQ(map.query(0.1, 0.1, 0.1).likeliestClass, synthetic_world::kRoad);
  EXPECT_EQ(map.query(0.1, 9.1, 0.1).likeliestClass, synthetic_world::kGrass);
  EXPECT_EQ(map.query(0.1, 0.1, 0.7).status, semantic_octree::CellState::Status::Unknown);
  EXPECT_EQ(map.query(10.1, 4.0, 0.7).likeliestClass, synthetic_world::kWall);
}

TEST(DriveStudy, TheOracleKnowsWhereAPathLeads) {
  const World world = withYard();
  const Task free = solved(world, {-8, 0, 0}, {3, 0, 0});
  EXPECT_TRUE(free.hasPath) << free.reason;
  EXPECT_NEAR(free.lengthPerClass[synthetic_world::kRoad], 11, 0.5);
  EXPECT_FALSE(solved(world, {-8, 0, 0}, {10, 0, 0}).hasPath);
}

TEST(DriveStudy, TellsFaults) {
  Trial trial;
  trial.task.hasPath = true;
  trial.record.end = DriveEnd::Arrived;
  trial.badFollowed = 10;
  trial.badDriven = 10.5;
  EXPECT_EQ(trial.fault(), "");
  trial.badDriven = 11;
  EXPECT_NE(trial.fault(), "");
  trial.badDriven = 0;
  trial.record.end = DriveEnd::Unreachable;
  EXPECT_EQ(trial.fault(), "did not arrive");
  trial.task.hasPath = false;
  EXPECT_EQ(trial.fault(), "");
  trial.record.end = DriveEnd::TimeLimit;
  EXPECT_NE(trial.fault(), "");
  trial.record.collisions = 1;
  EXPECT_EQ(trial.fault(), "collision");
}

TEST(DriveStudy, DrivesATaskAndCountsIt) {
  World world = withYard();
  Trial trial =
      runTrial(smallConfig(), world, syntheticOrder(), solved(world, {-8, 0, 0}, {3, 0, 0}));
  trial.scene = "yard";
  EXPECT_EQ(trial.fault(), "");
  EXPECT_EQ(trial.record.end, DriveEnd::Arrived);
  EXPECT_GE(trial.record.length, 10.7);
  const auto json = toJson(trial, syntheticOrder());
  EXPECT_EQ(json["scene"], "yard");
  EXPECT_EQ(json["drive"]["end"], "arrived");
  EXPECT_EQ(json["drive"]["meters"], trial.record.length);
}
