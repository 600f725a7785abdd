#include <gtest/gtest.h>
#include <semantic_types/ClassTable.h>

#include <cmath>

#include "CountedLabels.h"
#include "DataSets.h"
#include "GridFiles.h"
#include "SharedData.h"

namespace {

using semantic_map_export::Grid;
struct RightPoints {
  int points = 0, right = 0;
  void add(bool isRight) { ++points, right += isRight; }
  double value() const { return double(right) / points; }
};

/** Counts points near the sensor, which is 1.73 m above the street. Road is to be in free cells,
 * what stands half a meter to one and a half above it in occupied ones. */
void judge(const Grid& grid, const LabeledFrame& frame, const ClassTable& classes,
           RightPoints& road, RightPoints& standing) {
  for (std::size_t i = 0; i < frame.cloud.size(); ++i) {
    const Eigen::Vector3f& p = frame.cloud.points[i];
    const auto id = frame.cloud.classes[i];
    if (frame.isMoving(i) || id == 0 || p.norm() > 12) continue;
    const Eigen::Vector3d q = frame.T_map_sensor * p.cast<double>();
    const int cost = grid.at(int(std::floor((q.x() - grid.xMin) / grid.resolution)),
                             int(std::floor((q.y() - grid.yMin) / grid.resolution)));
    const std::string& name = classes.name(id);
    if (name == "road") road.add(cost == 0);
    if ((name == "car" || name == "building") && p.z() > -1.2f && p.z() < -0.3f)
      standing.add(cost == Grid::kLethal);
  }
}

}  // namespace

TEST(StreetGrid, theRoadIsFreeAndCarsAndWallsAreOccupied) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  const ClassTable classes = shippedTable("semantic_kitti.yaml");
  const auto frames = readSemanticKitti(sharedDataDir() / "semantic_kitti/00", classes);
  semantic_octree::SemanticOcTree map(0.2, classes);
  for (const LabeledFrame& frame : frames) map.insert(frame.cloud, frame.T_map_sensor);

  const Grid grid = semantic_map_export::gridOf(map, semantic_planning::VehicleOptions(), {});
  RightPoints road, standing;
  for (const LabeledFrame& frame : frames) judge(grid, frame, classes, road, standing);
  EXPECT_GT(road.points, 10000);
  EXPECT_GT(standing.points, 1000);
  EXPECT_GT(road.value(), 0.98);
  EXPECT_GT(standing.value(), 0.9);
}
