#include "ground_costs/GroundCosts.h"

#include <gtest/gtest.h>
#include <semantic_planning/planner/OrderFile.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>

#include <cmath>
#include <filesystem>
#include <numeric>
#include <random>


using ground_costs::GroundCosts;
using Box = GroundCosts::Box;

namespace {

colored_graph::ClassOrder orderOf(const std::string& name,
                                  const semantic_types::ClassTable& classes) {
  const std::filesystem::path config = std::filesystem::path(MSO_SOURCE_DIR) / "config";
  return semantic_planning::loadClassOrder(config / "orders" / (name + ".yaml"), classes);
}

std::vector<int> someCosts(const colored_graph::ClassOrder& order) {
  std::vector<int> costs(static_cast<std::size_t>(order.ranks()));
  std::iota(costs.begin(), costs.end(), 0);
  return costs;
}

void expectSame(const GroundCosts& a, const GroundCosts& b) {
  Box box = *a.box();
  box.add(b.box()->low), box.add(b.box()->high);
  for (int y = box.low.y; y <= box.high.y; ++y)
    for (int x = box.low.x; x <= box.high.x; ++x)
      ASSERT_EQ(int(a.at({x, y})), int(b.at({x, y}))) << x << ' ' << y;
}

}  // namespace

TEST(GroundCosts, areEvenUnlessTheyAreSaid) {
  EXPECT_EQ(ground_costs::evenCosts(4), (std::vector<int>{0, 30, 60, 90}));
  EXPECT_EQ(ground_costs::evenCosts(1), std::vector<int>{0});
}

TEST(GroundCosts, afterEachScanAreThoseOfTheWholeMap) {
  const auto classes = synthetic_world::classTable();
  const auto order = orderOf("synthetic", classes);
  const std::vector<int> costs = someCosts(order);
  synthetic_world::LidarOptions lidar;
  lidar.rings = 24, lidar.columns = 240, lidar.maxRange = 12;
  const auto scene = synthetic_world::makeScene("village", 3);
  std::mt19937 random(1);
  semantic_octree::SemanticOcTree map(0.25, classes);
  GroundCosts followed(map, order, {}, costs);
  Eigen::Isometry3d robot = Eigen::Isometry3d::Identity();
  for (int round = 0; round < 40; ++round) {
    // Patches of ground that others join later, and a robot that stands on one of them, or beside.
    const double way = 0.1 * (random() % 1200);
    const Eigen::Vector2d at = scene.route.at(way);
    const Eigen::Isometry3d T = scene.world.poseOnGround(at.x(), at.y(), scene.route.heading(way)) *
                                Eigen::Translation3d(0, 0, 1.5);
    map.insert(synthetic_world::scanLidar(scene.world, T, lidar), T);
    if (round % 5 == 0) robot = T * Eigen::Translation3d(0, 0, -1.5);
    if (round % 7 == 0) robot.translation().x() += 200;
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

namespace {

constexpr double kHeights[] = {0, 0.3, 1.73};  // of base_link above the ground, m

/** Each with its frame at another height. */
class SomeRobots {
 public:
  SomeRobots(semantic_octree::SemanticOcTree& map, const colored_graph::ClassOrder& order) {
    for (std::size_t i = 0; i < std::size(kHeights); ++i)
      m_costs.emplace_back(map, order, semantic_planning::PlannerOptions(), someCosts(order));
  }
  void follow(const Eigen::Isometry3d& T_map_ground) {
    for (std::size_t i = 0; i < std::size(kHeights); ++i)
      m_costs[i].follow(T_map_ground * Eigen::Translation3d(0, 0, kHeights[i]));
  }
  void expectSameGrids() const {
    for (const GroundCosts& costs : m_costs) expectSame(m_costs.front(), costs);
  }

 private:
  std::vector<GroundCosts> m_costs;
};

}  // namespace

TEST(GroundCosts, areTheSameWhereverBaseLinkIsOnTheRobot) {
  const auto scene = synthetic_world::makeScene("village", 3);
  semantic_octree::SemanticOcTree map(0.2, synthetic_world::classTable());
  SomeRobots robots(map, orderOf("synthetic", map.classes()));
  synthetic_world::LidarOptions lidar;
  lidar.rings = 32, lidar.columns = 360, lidar.maxRange = 20;
  for (double way = 0; way < 20; ++way) {
    const Eigen::Vector2d at = scene.route.at(way);
    const Eigen::Isometry3d T = scene.world.poseOnGround(at.x(), at.y(), scene.route.heading(way)),
                            T_map_sensor = T * Eigen::Translation3d(0, 0, 1.73);
    map.insert(synthetic_world::scanLidar(scene.world, T_map_sensor, lidar), T_map_sensor);
    robots.follow(T);
    robots.expectSameGrids();
  }
}
