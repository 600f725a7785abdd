// The program that doc/driving.md gives drives, here with the simulator in place of sensor and
// robot.
#include <gtest/gtest.h>
#include <mrpt/core/Clock.h>
#include <semantic_driving/DriveGuide.h>
#include <semantic_planning/planner/OrderAbstraction.h>

#include "Plain.h"
#include "simulated_drive/SimulatedRobot.h"
#include "simulated_drive/SimulatedSensors.h"

using namespace semantic_driving;
using namespace semantic_planning;
using mrpt::math::TPose2D;

namespace {

class Robot {
 public:
  Robot(const TPose2D& start, const DriveOptions& limits) : m_robot(start, limits) {
    mrpt::Clock::setActiveClock(mrpt::Clock::Source::Simulated);
  }

  const DriveState& state() const { return m_robot.state(); }
  double groundZ() const { return 0; }
  double time() const { return m_time; }
  void send(double speed, double turn) {
    m_robot.drive({speed, turn}, 0.1);
    m_time += 0.1;
    mrpt::Clock::setSimulatedTime(mrpt::Clock::fromDouble(1e9 + m_time));
  }

 private:
  simulated_drive::SimulatedRobot m_robot;
  double m_time = 0;
};

/** A LiDAR that turns twice a second. */
class Sensor {
 public:
  Sensor(const synthetic_world::World& world, const Robot& robot,
         const simulated_drive::SensorConfig& config)
      : m_world(world), m_robot(robot), m_sensors(lidarOf(config), false) {}

  bool hasNew() {
    if (age() < 0.5) return false;
    m_seenAt = m_robot.time();
    m_seen = m_sensors.sense(m_world, T_map_robot()).at(0);
    return true;
  }
  double age() const { return m_robot.time() - m_seenAt; }
  const semantic_types::LabeledCloud& cloud() const { return m_seen.cloud; }
  Eigen::Isometry3d T_map_sensor() const { return T_map_robot() * m_seen.T_robot_sensor; }

 private:
  static simulated_drive::SensorConfig lidarOf(simulated_drive::SensorConfig config) {
    config.hasCamera = false;
    return config;
  }
  Eigen::Isometry3d T_map_robot() const {
    const TPose2D& p = m_robot.state().pose;
    return m_world.poseOnGround(p.x, p.y, p.phi);
  }

  const synthetic_world::World& m_world;
  const Robot& m_robot;
  simulated_drive::SimulatedSensors m_sensors;
  simulated_drive::Observation m_seen;
  double m_seenAt = -1;
};

}  // namespace

TEST(YourOwnRobot, DrivesToItsGoalByTheProgramOfTheDocument) {
  const simulated_drive::DriveConfig config = smallConfig();
  const synthetic_world::World world = plain();
  const auto& classes = synthetic_world::classTable();
  const auto order = syntheticOrder();
  const PlannerOptions options = config.planner;
  const TPose2D goal(3, 1, 0);
  ReactiveNavigator::Options reactive;
  reactive.config = config.reactive;
  reactive.footprint = options.vehicle.footprint;
  Robot myRobot({-3, 0, 0}, {});
  Sensor mySensor(world, myRobot, config.sensors);

#include "YourOwnRobot.inc"

  EXPECT_TRUE(guide.arrived(myRobot.state(), drive)) << guide.reason();
}
