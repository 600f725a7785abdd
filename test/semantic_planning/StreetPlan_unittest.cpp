// Planning for a car over ten scans of SemanticKITTI 00.
#include <gtest/gtest.h>
#include <labeled_cloud/ClassTableFile.h>
#include <semantic_planning/OrderAbstraction.h>
#include <semantic_planning/OrderFile.h>
#include <semantic_planning/SemanticPlanner.h>

#include <algorithm>

#include "../real_data/DataSets.h"
#include "PathChecker.h"
#include "SharedData.h"

using namespace semantic_planning;
using mrpt::math::TPose2D;

namespace {

const std::filesystem::path kConfig = std::filesystem::path(MSO_SOURCE_DIR) / "config";

semantic_octree::SemanticOcTree streetMap() {
  const auto table = labeled_cloud::loadClassTable(kConfig / "classes/semantic_kitti.yaml");
  semantic_octree::SemanticOcTree map(0.2, table);
  semantic_octree::InsertionOptions insertion;
  insertion.maxRange = 50;
  insertion.minRange = 2.5;
  for (const LabeledFrame& frame : readSemanticKitti(sharedDataDir() / "semantic_kitti/00", table))
    map.insert(frame.cloud, frame.T_map_sensor, insertion);
  return map;
}

/** Labels the ground in a box anew, again and again, until that is its likeliest class. */
void recolor(semantic_octree::SemanticOcTree& map, const Ground& ground, double x0, double x1,
             double y0, double y1, const std::string& name) {
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  T_map_sensor.translation() = Eigen::Vector3d((x0 + x1) / 2, (y0 + y1) / 2, 3);
  semantic_octree::LabeledCloud cloud;
  for (double x = x0; x < x1; x += ground.voxelSize())
    for (double y = y0; y < y1; y += ground.voxelSize())
      if (const auto point = ground.find(x, y)) {
        const Eigen::Vector3d p(ground.centerOf(point->column.x), ground.centerOf(point->column.y),
                                ground.centerOf(point->surface.z));
        cloud.points.push_back((p - T_map_sensor.translation()).cast<float>());
        cloud.classes.push_back(*map.classes().find(name));
      }
  for (int i = 0; i < 20; ++i) map.insert(cloud, T_map_sensor);
}

}  // namespace

TEST(StreetPlan, aCarKeepsToTheRoadAndGoesAroundWhereItIsClosed) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  semantic_octree::SemanticOcTree map = streetMap();
  const auto meters = [&](const PlanResult& plan, const std::string& name) {
    return plan.lengthPerClass[*map.classes().find(name)];
  };
  const auto order = loadClassOrder(kConfig / "plan/semantic_kitti.yaml", map.classes());
  PlannerOptions options;
  options.vehicle = loadVehicle(kConfig / "plan/car.yaml");
  map.setAbstraction(abstractionFor(order));
  SemanticPlanner planner(map, order, options);
  const TPose2D start(-24, -14, M_PI / 4), goal(-14, 15, 130 * M_PI / 180);

  const PlanResult open = planner.plan(start, goal);
  ASSERT_TRUE(open.found()) << open.reason;
  EXPECT_GT(meters(open, "road"), 0.95 * open.length);
  PathChecker(map, options.vehicle).expectDrivable(open.path);

  const double west = -13.5, east = -8.5, south = 9, north = 11;  // of what is closed
  const auto inside = [&](const PathPoint& p) {
    return p.x > west && p.x < east && p.y > south && p.y < north;
  };
  EXPECT_TRUE(std::any_of(open.path.begin(), open.path.end(), inside));
  recolor(map, planner.ground(), west, east, south, north, "other-ground");
  const UpdateResult update = planner.update();
  EXPECT_GT(update.edgesChanged + update.edgesInserted + update.edgesRemoved, 0u);
  const PlanResult closed = planner.replan(start);
  ASSERT_TRUE(closed.found()) << closed.reason;
  EXPECT_EQ(meters(closed, "other-ground"), 0);
  EXPECT_TRUE(std::none_of(closed.path.begin(), closed.path.end(), inside));
  EXPECT_GT(closed.cost, open.cost);
  PathChecker(map, options.vehicle).expectDrivable(closed.path);
}
