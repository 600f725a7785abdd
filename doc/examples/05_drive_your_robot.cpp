// A robot drives through a village of which it has no map: 05_drive_your_robot REACTIVE.ini
#include <mrpt/core/Clock.h>
#include <semantic_driving/DriveGuide.h>
#include <semantic_planning/planner/OrderAbstraction.h>
#include <synthetic_world/Lidar.h>
#include <synthetic_world/Scene.h>
#include <iostream>

int main(int argc, char** argv) {
  const auto world = synthetic_world::makeScene("village", 1).world;
  semantic_octree::SemanticOcTree map(0.2, synthetic_world::classTable());
  // From best to worst: road and its markings, sidewalk and gravel, dirt, grass, unknown ground.
  const colored_graph::ClassOrder order(map.numClasses() + 1, {{1, 2}, {3, 4}, {5}, {6}, {0}});
  setAbstraction(map, semantic_planning::abstractionFor(order));
  semantic_planning::SemanticPlanner planner(map, order);
  semantic_driving::DriveGuide guide({}, planner, {0, -18, 0});  // which path is driven
  semantic_driving::ReactiveNavigator::Options reactive;
  reactive.config = argc > 1 ? argv[1] : "config/reactive/robot.ini";
  reactive.footprint = planner.options().vehicle.footprint;
  semantic_driving::DriveController drive({}, reactive);  // how it is followed
  semantic_driving::DriveState robot{{-14, -18.6, 0.17}};
  mrpt::Clock::setActiveClock(mrpt::Clock::Source::Simulated);  // yours has the real time
  for (int step = 0; !guide.gaveUp() && !guide.arrived(robot, drive); ++step) {
    const double seconds = 0.1 * step, age = 0.1 * (step % 5);  // of the newest scan
    mrpt::Clock::setSimulatedTime(mrpt::Clock::fromDouble(1e9 + seconds));
    const auto T_map_robot = world.poseOnGround(robot.pose.x, robot.pose.y, robot.pose.phi);
    const double z = T_map_robot.translation().z();
    if (age == 0) {  // 1: your sensor's points with their classes, and its pose
      const Eigen::Isometry3d T_map_sensor = T_map_robot * Eigen::Translation3d(0, 0, 1.5);
      map.insert(scanLidar(world, T_map_sensor, {32, 512, -45, 15, 0.8, 20, {}}), T_map_sensor);
      planner.update();
      guide.update(robot, z, drive, seconds);
    }
    const auto obstacles = senseObstacles(planner, robot.pose, z, guide.obstacles());
    const auto c = drive.step(robot, obstacles, age, seconds);  // 2: to your motors
    robot = {robot.pose + mrpt::math::TPose2D(0.1 * c.speed, 0, 0.1 * c.turn), c.speed, c.turn};
  }
  std::cout << (guide.gaveUp() ? guide.reason() : "arrived") << "\n";
}
