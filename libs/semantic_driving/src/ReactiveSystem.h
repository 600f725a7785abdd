#pragma once
#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/core/Clock.h>
#include <mrpt/kinematics/CVehicleVelCmd_DiffDriven.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/nav/reactive/CAbstractPTGBasedReactive.h>
#include <mrpt/version.h>
#include <semantic_driving/ReactiveNavigator.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace semantic_driving {

/** A folder for the tables that MRPT keeps, gone when it is not needed any more. */
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "reactive-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error(name + ": cannot be created");
    m_path = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(m_path, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return m_path; }

 private:
  std::filesystem::path m_path;
};

/** The vehicle as MRPT's navigator sees it. */
class Vehicle : public mrpt::nav::CRobot2NavInterface {
 public:
  DriveState state;
  ObstaclePoints3 obstacles;
  DriveCommand command;
  double seconds = 0;

  bool getCurrentPoseAndSpeeds(mrpt::math::TPose2D& pose, mrpt::math::TTwist2D& velocity,
                               mrpt::system::TTimeStamp& time, mrpt::math::TPose2D& odometry,
                               std::string& frame) override {
    pose = odometry = state.pose;
    velocity = {state.speed * std::cos(pose.phi), state.speed * std::sin(pose.phi), state.turn};
    time = mrpt::Clock::now();
    frame = "map";
    return true;
  }
  bool changeSpeeds(const mrpt::kinematics::CVehicleVelCmd& wanted) override {
    const auto& drive = dynamic_cast<const mrpt::kinematics::CVehicleVelCmd_DiffDriven&>(wanted);
    command = {drive.lin_vel, drive.ang_vel};
    return true;
  }
  bool stop(bool) override {
    command = {};
    return true;
  }
  mrpt::kinematics::CVehicleVelCmd::Ptr getEmergencyStopCmd() override { return getStopCmd(); }
  mrpt::kinematics::CVehicleVelCmd::Ptr getStopCmd() override {
    return std::make_shared<mrpt::kinematics::CVehicleVelCmd_DiffDriven>();
  }
  bool senseObstacles(mrpt::maps::CSimplePointsMap& points,
                      mrpt::system::TTimeStamp& time) override {
    points.clear();
    for (const Eigen::Vector3d& o : obstacles) points.insertPoint(o.x(), o.y(), o.z());
    time = mrpt::Clock::now();
    return true;
  }
  double getNavigationTime() override { return seconds; }
  void resetNavigationTimer() override {}

  bool blocked = false;
  void sendWaySeemsBlockedEvent() override { blocked = true; }
  void sendCannotGetCloserToBlockedTargetEvent() override { blocked = true; }
  void sendApparentCollisionEvent() override {}
  void sendNavigationStartEvent() override {}
  void sendNavigationEndEvent() override {}
  void sendNavigationEndDueToErrorEvent() override { blocked = true; }
  void sendWaypointReachedEvent(int, bool) override {}
  void sendNewWaypointTargetEvent(int) override {}
};

/** How many factors CHolonomicFullEval weighs: it refuses lists that are shorter or longer, so that
 * no file would serve all releases. 0x258 is 2.5.8, see semantic_map/MrptVersion.h. */
constexpr std::size_t kHolonomicFactors = MRPT_VERSION >= 0x020e03 ? 8 : 7;

/** Appends zeros, which weigh nothing, to lists of the seven factors that all releases have. */
void completeHolonomicFactors(mrpt::config::CConfigFileBase& file, std::size_t factors);

/** MRPT's navigator for a shape that is the same at all heights, or made of slices; ready to run.
 * \param tables folder of the tables that MRPT makes
 * \throw std::exception the file is missing, or what MRPT does not like about it. */
std::unique_ptr<mrpt::nav::CAbstractPTGBasedReactive> makeReactiveSystem(
    Vehicle& vehicle, const ReactiveNavigator::Options& options,
    const std::filesystem::path& tables);

}  // namespace semantic_driving
