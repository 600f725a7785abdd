#include "GroundCosts.h"

#include <gtest/gtest.h>
#include <semantic_planning/planner/OrderFile.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>

#include <filesystem>
#include <numeric>
#include <random>

using semantic_map_ros2::GroundCosts;
using Box = GroundCosts::Box;

namespace {

void expectSame(const GroundCosts& a, const GroundCosts& b) {
  Box box = *a.box();
  box.add(b.box()->low), box.add(b.box()->high);
  for (int y = box.low.y; y <= box.high.y; ++y)
    for (int x = box.low.x; x <= box.high.x; ++x)
      ASSERT_EQ(int(a.at({x, y})), int(b.at({x, y}))) << x << ' ' << y;
}

}  // namespace

TEST(GroundCosts, afterEachScanAreThoseOfTheWholeMap) {
  const std::filesystem::path config = std::filesystem::path(MSO_SOURCE_DIR) / "config";
  const auto classes = semantic_types::loadClassTable(config / "classes/synthetic.yaml");
  const auto order = semantic_planning::loadClassOrder(config / "orders/synthetic.yaml", classes);
  std::vector<int> costs(static_cast<std::size_t>(order.ranks()));
  std::iota(costs.begin(), costs.end(), 0);
  synthetic_world::LidarOptions lidar;
  lidar.rings = 24, lidar.columns = 240, lidar.maxRange = 12;
  const auto scene = synthetic_world::makeScene("village", 3);
  std::mt19937 random(1);
  semantic_octree::SemanticOcTree map(0.25, classes);
  GroundCosts followed(map, order, {}, costs);
  Eigen::Vector3d robot = Eigen::Vector3d::Zero();
  for (int round = 0; round < 40; ++round) {
    // Patches of ground that others join later, and a robot that stands on one of them, or beside.
    const double way = 0.1 * (random() % 1200);
    const Eigen::Vector2d at = scene.route.at(way);
    const Eigen::Isometry3d T = scene.world.poseOnGround(at.x(), at.y(), scene.route.heading(way)) *
                                Eigen::Translation3d(0, 0, 1.5);
    map.insert(synthetic_world::scanLidar(scene.world, T, lidar), T);
    if (round % 5 == 0) robot = T.translation() - Eigen::Vector3d(0, 0, 1.5);
    if (round % 7 == 0) robot.x() += 200;
    const auto box = followed.box();
    const auto cells = followed.cells();
    const auto changed = followed.follow(robot);
    GroundCosts anew(map, order, {}, costs);
    anew.follow(robot);
    ASSERT_TRUE(followed.box() && anew.box());
    ASSERT_NO_FATAL_FAILURE(expectSame(followed, anew)) << round;
    if (!box || !(*box == *followed.box())) continue;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const int width = box->width(), x = int(i) % width, y = int(i) / width;
      if (changed && changed->has({box->low.x + x, box->low.y + y})) continue;
      ASSERT_EQ(int(followed.cells()[i]), int(cells[i])) << "changed in silence";
    }
  }
}
