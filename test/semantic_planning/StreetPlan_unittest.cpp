// Planning over ten scans of SemanticKITTI 00, and of 07.
#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/planner/SemanticPlanner.h>
#include <semantic_planning/vehicle/VehicleOptions.h>
#include <semantic_types/ClassTable.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "DataSets.h"
#include "PathChecker.h"
#include "SharedData.h"

using namespace semantic_planning;
using mrpt::math::TPose2D;

namespace {

const std::filesystem::path kConfig = std::filesystem::path(MSO_SOURCE_DIR) / "config";

class StreetPlan : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_DATA("semantic_kitti");
    if (!s_street) readStreet();
    map.emplace(*s_street);
    order.emplace(loadClassOrder(kConfig / "orders/semantic_kitti.yaml", map->classes()));
    setAbstraction(*map, abstractionFor(*order));
  }

  static void TearDownTestSuite() { s_street.reset(); }

  static void readStreet() { s_street = mapOf("00", s_driven); }

  static semantic_octree::SemanticOcTree mapOf(const std::string& sequence,
                                               std::vector<Eigen::Isometry3d>& driven) {
    const auto table = semantic_types::loadClassTable(kConfig / "classes/semantic_kitti.yaml");
    semantic_octree::SemanticOcTree street(0.2, table);
    semantic_octree::InsertionOptions insertion;
    insertion.maxRange = 50;
    insertion.minRange = 3;
    for (const LabeledFrame& frame :
         readSemanticKitti(sharedDataDir() / "semantic_kitti" / sequence, table)) {
      street.insert(frame.cloud, frame.T_map_sensor, insertion);
      driven.push_back(frame.T_map_sensor);
    }
    return street;
  }

  static TPose2D planarPose(const Eigen::Isometry3d& T_map_sensor) {
    const Eigen::Vector3d at = T_map_sensor.translation(), ahead = T_map_sensor.linear().col(0);
    return {at.x(), at.y(), std::atan2(ahead.y(), ahead.x())};
  }

  double meters(const PlanResult& plan, const std::string& name) const {
    return plan.lengthPerClass[*map->classes().find(name)];
  }

  static inline std::optional<semantic_octree::SemanticOcTree> s_street;
  static inline std::vector<Eigen::Isometry3d> s_driven;
  std::optional<semantic_octree::SemanticOcTree> map;
  std::optional<colored_graph::ClassOrder> order;
  PlannerOptions options;
  const TPose2D start{-24, -14, M_PI / 4}, goal{-14, 15, 130 * M_PI / 180};
};

struct Box {
  double west, east, south, north;  // m

  bool contains(double x, double y) const { return x > west && x < east && y > south && y < north; }
};

bool goesThrough(const PlanResult& plan, const Box& box) {
  return std::any_of(plan.path.begin(), plan.path.end(),
                     [&](const PathPoint& p) { return box.contains(p.x, p.y); });
}

/** Labels the ground in a box anew, again and again, until that is its likeliest class. */
void recolor(semantic_octree::SemanticOcTree& map, const Ground& ground, const Box& box,
             const std::string& name) {
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  T_map_sensor.translation() =
      Eigen::Vector3d((box.west + box.east) / 2, (box.south + box.north) / 2, 3);
  semantic_types::LabeledCloud cloud;
  for (double x = box.west; x < box.east; x += ground.voxelSize())
    for (double y = box.south; y < box.north; y += ground.voxelSize())
      if (const auto point = ground.find(x, y)) {
        const Eigen::Vector3d p(ground.centerOf(point->column.x), ground.centerOf(point->column.y),
                                ground.centerOf(point->surface.z));
        cloud.points.push_back((p - T_map_sensor.translation()).cast<float>());
        cloud.classes.push_back(*map.classes().find(name));
      }
  for (int i = 0; i < 20; ++i) map.insert(cloud, T_map_sensor);
}

}  // namespace

TEST_F(StreetPlan, theWayThatTheCarDroveIsFreeForIt) {
  options.vehicle = loadVehicle(kConfig / "vehicles/car.yaml");
  const SemanticPlanner planner(*map, *order, options);
  for (const Eigen::Isometry3d& T_map_sensor : s_driven) {
    const TPose2D pose = planarPose(T_map_sensor);
    EXPECT_EQ(planner.check(pose), PlanStatus::Found) << pose.asString();
  }
}

TEST_F(StreetPlan, aCarStartsWhereTheRecordingCarStoodThoughItsLidarDidNotSeeTheRoadThere) {
  options.vehicle = loadVehicle(kConfig / "vehicles/car.yaml");
  std::vector<Eigen::Isometry3d> driven;
  semantic_octree::SemanticOcTree crossing = mapOf("07", driven);
  setAbstraction(crossing, abstractionFor(*order));
  SemanticPlanner planner(crossing, *order, options);
  for (const Eigen::Isometry3d& T_map_sensor : driven)
    EXPECT_NE(planner.check(planarPose(T_map_sensor)), PlanStatus::Found) << "it is known";
  for (const Eigen::Isometry3d& T_map_sensor : driven) {
    const TPose2D pose = planarPose(T_map_sensor);
    const TPose2D ahead = pose + TPose2D(10, 0, 0);
    const PlanResult plan = planner.plan(pose, ahead);
    ASSERT_TRUE(plan.found()) << pose.asString() << plan.reason;
    EXPECT_LT(plan.length, 10.5);
  }
}

TEST_F(StreetPlan, aCarKeepsToTheRoadAndGoesAroundWhereItsLaneIsClosed) {
  options.vehicle = loadVehicle(kConfig / "vehicles/car.yaml");
  SemanticPlanner planner(*map, *order, options);
  const PlanResult open = planner.plan(start, goal);
  ASSERT_TRUE(open.found()) << open.reason;
  EXPECT_GT(meters(open, "road"), 0.95 * open.length);
  PathChecker(*map, options.vehicle).expectDrivable(open.path);

  const Box lane{-13.5, -8.5, 9, 11};
  EXPECT_TRUE(goesThrough(open, lane));
  recolor(*map, planner.ground(), lane, "other-ground");
  planner.update();
  const PlanResult closed = planner.replan(start);
  ASSERT_TRUE(closed.found()) << closed.reason;
  EXPECT_EQ(meters(closed, "other-ground"), 0);
  EXPECT_FALSE(goesThrough(closed, lane));
  EXPECT_GT(closed.cost, open.cost);
  PathChecker(*map, options.vehicle).expectDrivable(closed.path);
}

TEST_F(StreetPlan, whereTheWholeStreetIsClosedASmallRobotGoesAroundBetweenTheTrees) {
  options.vehicle = loadVehicle(kConfig / "vehicles/robot.yaml");
  options.roadmap.buffer = 12;
  options.roadmap.vertices = 2000;
  SemanticPlanner planner(*map, *order, options);
  const PlanResult open = planner.plan(start, goal);
  ASSERT_TRUE(open.found()) << open.reason;
  EXPECT_EQ(meters(open, "terrain"), 0);

  const Box street{-12, -2.5, 8, 12};  // with the sidewalk
  EXPECT_TRUE(goesThrough(open, street));
  recolor(*map, planner.ground(), street, "other-ground");
  planner.update();
  const PlanResult closed = planner.replan(start);
  ASSERT_TRUE(closed.found()) << closed.reason;
  EXPECT_FALSE(goesThrough(closed, street));
  EXPECT_GT(meters(closed, "terrain"), 3);
  EXPECT_EQ(meters(closed, "other-ground"), 0);
  EXPECT_GT(closed.cost, open.cost);
  PathChecker(*map, options.vehicle).expectDrivable(closed.path);
}
