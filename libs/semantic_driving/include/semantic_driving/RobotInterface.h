#pragma once
#include <mrpt/core/Clock.h>
#include <mrpt/kinematics/CVehicleVelCmd_DiffDriven.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/nav/reactive/CRobot2NavInterface.h>
#include <mrpt_compat/Release.h>
#include <semantic_driving/DriveOptions.h>

#include <cmath>
#include <optional>

namespace semantic_driving {

/** A robot as MRPT's navigators see it (CReactiveNavigationSystem and others). Before each step it
 * is told where it is and what is in the way, afterwards it has the command. For a robot of your
 * own, derive from it or tell it what your sensors say. */
class RobotInterface : public mrpt::nav::CRobot2NavInterface {
 public:
  DriveState state;          ///< in the map's frame
  ObstaclePoints obstacles;  ///< in the robot's frame, meters
  DriveCommand command;      ///< what the navigator wants; it stands until it says otherwise
  double seconds = 0;        ///< of the clock that runs while navigating
  bool blocked = false;      ///< the navigator finds no way, or gave up

#if MSO_MRPT_AT_LEAST(3, 0, 0)
  std::optional<CurrentPoseAndSpeeds> getCurrentPoseAndSpeeds() override {
    return CurrentPoseAndSpeeds{state.pose, velocity(), mrpt::Clock::now(), state.pose, "map"};
  }
  bool stop(mrpt::nav::StopType) override { return halt(); }
#else
  bool getCurrentPoseAndSpeeds(mrpt::math::TPose2D& pose, mrpt::math::TTwist2D& twist,
                               mrpt::system::TTimeStamp& time, mrpt::math::TPose2D& odometry,
                               std::string& frame) override {
    pose = odometry = state.pose;
    twist = velocity();
    time = mrpt::Clock::now();
    frame = "map";
    return true;
  }
  bool stop(bool) override { return halt(); }
#endif
  bool changeSpeeds(const mrpt::kinematics::CVehicleVelCmd& wanted) override {
    const auto& drive = dynamic_cast<const mrpt::kinematics::CVehicleVelCmd_DiffDriven&>(wanted);
    command = {drive.lin_vel, drive.ang_vel};
    return true;
  }
  mrpt::kinematics::CVehicleVelCmd::Ptr getEmergencyStopCmd() override { return getStopCmd(); }
  mrpt::kinematics::CVehicleVelCmd::Ptr getStopCmd() override {
    return std::make_shared<mrpt::kinematics::CVehicleVelCmd_DiffDriven>();
  }
  bool senseObstacles(mrpt::maps::CSimplePointsMap& points,
                      mrpt::system::TTimeStamp& time) override {
    points.clear();
    constexpr double kHeight = 0.5;  // m; whatever: the shape is the same at all heights
    for (const Eigen::Vector2d& o : obstacles) points.insertPoint(o.x(), o.y(), kHeight);
    time = mrpt::Clock::now();
    return true;
  }
  double getNavigationTime() override { return seconds; }
  void resetNavigationTimer() override {}

  void sendWaySeemsBlockedEvent() override { blocked = true; }
  void sendCannotGetCloserToBlockedTargetEvent() override { blocked = true; }
  void sendApparentCollisionEvent() override {}
  void sendNavigationStartEvent() override {}
  void sendNavigationEndEvent() override {}
  void sendNavigationEndDueToErrorEvent() override { blocked = true; }
  void sendWaypointReachedEvent(int, bool) override {}
  void sendNewWaypointTargetEvent(int) override {}

 private:
  /** In the map's frame, m/s and rad/s. */
  mrpt::math::TTwist2D velocity() const {
    const double heading = state.pose.phi;
    return {state.speed * std::cos(heading), state.speed * std::sin(heading), state.turn};
  }
  bool halt() {
    command = {};
    return true;
  }
};

}  // namespace semantic_driving
