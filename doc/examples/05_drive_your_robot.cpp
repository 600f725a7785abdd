// A robot drives through a village of which it has no map: 05_drive_your_robot REACTIVE.ini
#include <mrpt/core/Clock.h>
#include <semantic_navigation/Navigator.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>
#include <iostream>

int main(int argc, char** argv) {
  const auto world = synthetic_world::makeScene("village", 1).world;
  semantic_octree::SemanticOcTree map(0.2, synthetic_world::classTable());
  semantic_slam::MapperOptions mapping;
  mapping.localize = mapping.slam.level = true;  // x, y, heading
  semantic_slam::Mapper mapper(map, mapping);
  // From best to worst: road and its markings, sidewalk and gravel, dirt, grass, unknown ground.
  const colored_graph::ClassOrder order(map.numClasses() + 1, {{1, 2}, {3, 4}, {5}, {6}, {0}});
  semantic_navigation::NavigatorOptions options;
  options.reactive = argc > 1 ? argv[1] : "config/reactive/robot.ini";
  options.mappingLatency = 0.2;  // s: a thread inserts while the robot drives on
  semantic_navigation::Navigator navigator(mapper, order, options);
  navigator.setGoal({0, -18, 0});
  semantic_navigation::RobotState robot{{{-14, -18.6, 0.17}}};
  semantic_slam::SensorScan scan{{}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.5))};
  mrpt::Clock::setActiveClock(mrpt::Clock::Source::Simulated);  // yours has the real time
  for (int step = 0; navigator.isDriving(); ++step) {
    const double seconds = 0.1 * step;
    mrpt::Clock::setSimulatedTime(mrpt::Clock::fromDouble(1e9 + seconds));
    const auto pose = robot.drive.pose;
    robot.T_odometry_robot = world.poseOnGround(pose.x, pose.y, pose.phi);
    navigator.update(robot);  // 1: your odometry
    if (step % 5 == 0) {      // 2: your sensors' points with their classes
      const auto T_map_sensor = robot.T_odometry_robot * scan.T_robot_sensor;
      scan.cloud = scanLidar(world, T_map_sensor, {32, 512, -45, 15, 20, 0, {}});
      navigator.see({scan}, seconds);
    }
    const auto c = navigator.step(seconds);  // 3: to your motors
    robot.drive = {pose + mrpt::math::TPose2D(0.1 * c.speed, 0, 0.1 * c.turn), c.speed, c.turn};
  }
  std::cout << (navigator.hasArrived() ? "arrived" : navigator.reason()) << "\n";
}
