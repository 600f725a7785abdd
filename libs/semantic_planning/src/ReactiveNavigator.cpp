#include <mrpt/config/CConfigFile.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/core/Clock.h>
#include <mrpt/kinematics/CVehicleVelCmd_DiffDriven.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/nav/reactive/CReactiveNavigationSystem.h>
#include <semantic_planning/ReactiveNavigator.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace semantic_planning {

using mrpt::kinematics::CVehicleVelCmd;
using mrpt::kinematics::CVehicleVelCmd_DiffDriven;
using mrpt::nav::CReactiveNavigationSystem;

namespace {

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
  ObstaclePoints obstacles;
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
  bool changeSpeeds(const CVehicleVelCmd& wanted) override {
    const auto& drive = dynamic_cast<const CVehicleVelCmd_DiffDriven&>(wanted);
    command = {drive.lin_vel, drive.ang_vel};
    return true;
  }
  bool stop(bool) override {
    command = {};
    return true;
  }
  CVehicleVelCmd::Ptr getEmergencyStopCmd() override { return getStopCmd(); }
  CVehicleVelCmd::Ptr getStopCmd() override {
    return std::make_shared<CVehicleVelCmd_DiffDriven>();
  }
  bool senseObstacles(mrpt::maps::CSimplePointsMap& points,
                      mrpt::system::TTimeStamp& time) override {
    points.clear();
    for (const Eigen::Vector2d& o : obstacles) points.insertPoint(o.x(), o.y(), 0.5);
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

/** Does not print how long everything took when it is gone. */
class QuietNavigationSystem : public CReactiveNavigationSystem {
 public:
  using CReactiveNavigationSystem::CReactiveNavigationSystem;
  ~QuietNavigationSystem() override { m_timlog_delays.clear(true); }
};

/** The outline, each corner moved away from the middle so that the edges move by the margin. */
mrpt::math::CPolygon widened(const std::vector<Eigen::Vector2d>& footprint, double margin) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : footprint) middle += p / static_cast<double>(footprint.size());
  mrpt::math::CPolygon shape;
  for (const Eigen::Vector2d& p : footprint) {
    const Eigen::Vector2d d = p - middle;
    const Eigen::Vector2d sign(d.x() < 0 ? -1 : 1, d.y() < 0 ? -1 : 1);
    const Eigen::Vector2d corner = p + margin * sign;
    shape.AddVertex(corner.x(), corner.y());
  }
  return shape;
}

}  // namespace

struct ReactiveNavigator::Navigation {
  explicit Navigation(const Options& options)
      : system(vehicle, false, !options.logFolder.empty(), options.logFolder.string()) {
    if (!std::filesystem::exists(options.config))
      throw std::runtime_error(options.config.string() + ": no such file");
    mrpt::config::CConfigFile file(options.config.string());
    const auto both = [&](const std::string& key, double value) {
      file.write("CAbstractPTGBasedReactive", key, value);
    };
    const double turn = options.maxSpeed / options.turningRadius * 180 / M_PI;
    both("robotMax_V_mps", options.maxSpeed);
    both("robotMax_W_degps", turn);
    const int count = file.read_int("CReactiveNavigationSystem", "PTG_COUNT", 0, true);
    for (int i = 0; i < count; ++i) {
      const std::string name = "PTG" + std::to_string(i);
      file.write("CReactiveNavigationSystem", name + "_v_max_mps", options.maxSpeed);
      file.write("CReactiveNavigationSystem", name + "_w_max_dps", turn);
    }
    file.discardSavingChanges();  // or MRPT writes the file anew
    system.logging_enable_console_output = false;
    vehicle.logging_enable_console_output = false;
    system.enableRethrowNavExceptions(true);
    system.loadConfigFile(file);
    // MRPT 2.5.8 does not read the key of this name.
    system.params_abstract_ptg_navigator.ptg_cache_files_directory = scratch.path().string();
    system.changeRobotShape(widened(options.footprint, options.margin));
    system.initialize();
  }

  ScratchFolder scratch;
  Vehicle vehicle;
  QuietNavigationSystem system;
  bool started = false;
};

ReactiveNavigator::ReactiveNavigator(const Options& options)
    : m_navigation(std::make_unique<Navigation>(options)) {}
ReactiveNavigator::~ReactiveNavigator() = default;
ReactiveNavigator::ReactiveNavigator(ReactiveNavigator&&) noexcept = default;

void ReactiveNavigator::setWaypoints(const std::vector<PathPoint>& waypoints, double reach) {
  mrpt::nav::TWaypointSequence sequence;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const bool last = i + 1 == waypoints.size();
    mrpt::nav::TWaypoint waypoint(waypoints[i].x, waypoints[i].y, reach, false);
    waypoint.speed_ratio = last ? 0.3 : 1.0;
    sequence.waypoints.push_back(waypoint);
  }
  m_navigation->vehicle.blocked = false;
  m_navigation->started = true;
  m_navigation->system.resetNavError();
  m_navigation->system.navigateWaypoints(sequence);
}

void ReactiveNavigator::cancel() {
  m_navigation->started = false;
  m_navigation->system.cancel();
}

DriveCommand ReactiveNavigator::step(const DriveState& state, const ObstaclePoints& obstacles,
                                     double seconds) {
  Vehicle& vehicle = m_navigation->vehicle;
  vehicle.state = state;
  vehicle.obstacles = obstacles;
  vehicle.seconds = seconds;
  try {
    m_navigation->system.navigationStep();
  } catch (const std::exception&) {
    // MRPT throws, too, if the first places that it is asked for are beyond all its trajectories.
    vehicle.blocked = true;
    vehicle.command = {};
  }
  return vehicle.command;
}

ReactiveNavigator::Status ReactiveNavigator::status() const {
  if (!m_navigation->started) return Status::Idle;
  if (m_navigation->vehicle.blocked) return Status::Blocked;
  switch (m_navigation->system.getCurrentState()) {
    case CReactiveNavigationSystem::NAVIGATING:
      return Status::Driving;
    case CReactiveNavigationSystem::NAV_ERROR:
      return Status::Blocked;
    default:
      return Status::Arrived;
  }
}

}  // namespace semantic_planning
