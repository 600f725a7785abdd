#include <semantic_driving/ReactiveNavigator.h>

#include <mrpt/config/CConfigFile.h>
#include <mrpt/nav/reactive/CReactiveNavigationSystem.h>
#include <strict_files/TextFile.h>

#include <iomanip>
#include <limits>
#include <sstream>

#include "ReactiveSystem.h"

namespace semantic_driving {

using mrpt::config::CConfigFile;
using mrpt::nav::CReactiveNavigationSystem;
using semantic_planning::PathPoint;
using Options = ReactiveNavigator::Options;

struct ReactiveNavigator::Navigation {
  Navigation(const Options& options, const DriveOptions& limits)
      : system(makeReactiveSystem(robot, options, limits, scratch.path())) {}

  ScratchFolder scratch;
  RobotInterface robot;
  std::unique_ptr<mrpt::nav::CAbstractPTGBasedReactive> system;
  bool started = false;
};

ReactiveNavigator::ReactiveNavigator(const Options& options, const DriveOptions& limits)
    : m_navigation(std::make_unique<Navigation>(options, limits)) {}
ReactiveNavigator::~ReactiveNavigator() = default;

void ReactiveNavigator::setWaypoints(const std::vector<PathPoint>& waypoints, double reach) {
  mrpt::nav::TWaypointSequence sequence;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const bool last = i + 1 == waypoints.size();
    mrpt::nav::TWaypoint waypoint(waypoints[i].x, waypoints[i].y, reach, false);
    waypoint.speed_ratio = last ? 0.3 : 1.0;
    sequence.waypoints.push_back(waypoint);
  }
  m_navigation->robot.blocked = false;
  m_navigation->started = true;
  m_navigation->system->resetNavError();
  m_navigation->system->navigateWaypoints(sequence);
}

DriveCommand ReactiveNavigator::step(const DriveState& state, const ObstaclePoints& obstacles,
                                     double seconds) {
  RobotInterface& robot = m_navigation->robot;
  robot.state = state;
  robot.obstacles = obstacles;
  robot.seconds = seconds;
  try {
    m_navigation->system->navigationStep();
  } catch (const std::exception&) {
    // MRPT throws, too, if the first places that it is asked for are beyond all its trajectories.
    robot.blocked = true;
    robot.command = {};
  }
  return robot.command;
}

ReactiveNavigator::Status ReactiveNavigator::status() const {
  if (!m_navigation->started) return Status::Idle;
  if (m_navigation->robot.blocked) return Status::Blocked;
  switch (m_navigation->system->getCurrentState()) {
    case mrpt::nav::CAbstractNavigator::TState::NAVIGATING:
      return Status::Driving;
    case mrpt::nav::CAbstractNavigator::TState::NAV_ERROR:
      return Status::Blocked;
    default:
      return Status::Arrived;
  }
}

namespace {

const std::string kSection = "CReactiveNavigationSystem";

/** Does not print how long everything took when it is gone. */
class Quiet : public CReactiveNavigationSystem {
 public:
  using CReactiveNavigationSystem::CReactiveNavigationSystem;
  ~Quiet() override { m_timlog_delays.clear(true); }
};

void writeLimits(CConfigFile& file, const DriveOptions& limits) {
  const double turn = limits.maxSpeed / limits.turningRadius * 180 / M_PI;
  file.write("CAbstractPTGBasedReactive", "robotMax_V_mps", limits.maxSpeed);
  file.write("CAbstractPTGBasedReactive", "robotMax_W_degps", turn);
  const int count = file.read_int(kSection, "PTG_COUNT", 0, true);
  for (int i = 0; i < count; ++i) {
    const std::string name = "PTG" + std::to_string(i);
    file.write(kSection, name + "_v_max_mps", limits.maxSpeed);
    file.write(kSection, name + "_w_max_dps", turn);
  }
}

}  // namespace

void completeHolonomicFactors(mrpt::config::CConfigFileBase& file, std::size_t factors) {
  const std::string section = "CHolonomicFullEval";
  for (const char* key : {"factorWeights", "factorNormalizeOrNot"}) {
    std::vector<double> values;
    file.read_vector(section, key, values, values);
    if (values.size() != 7 || factors == 7) continue;
    values.resize(factors, 0);
    std::ostringstream list;
    const strict_files::ClassicNumbers classic(list);
    list << std::setprecision(std::numeric_limits<double>::max_digits10);
    for (const double value : values) list << value << ' ';
    file.write(section, key, list.str());
  }
}

std::unique_ptr<mrpt::nav::CAbstractPTGBasedReactive> makeReactiveSystem(
    RobotInterface& robot, const Options& options, const DriveOptions& limits,
    const std::filesystem::path& tables) {
  if (!std::filesystem::exists(options.config))
    throw std::runtime_error(options.config.string() + ": no such file");
  CConfigFile file(options.config.string());
  writeLimits(file, limits);
  completeHolonomicFactors(file, kHolonomicFactors);
  file.discardSavingChanges();  // or MRPT writes the file anew
  robot.logging_enable_console_output = false;
  auto system = std::make_unique<Quiet>(robot, false);
  system->logging_enable_console_output = false;
  system->setLogFileDirectory(options.logFolder.string());
  system->enableLogFile(!options.logFolder.empty());
  system->enableRethrowNavExceptions(true);
  system->loadConfigFile(file);
  // MRPT 2.5.8 does not read the key of this name.
  system->params_abstract_ptg_navigator.ptg_cache_files_directory = tables.string();
  mrpt::math::CPolygon shape;
  for (const Eigen::Vector2d& p : options.footprint.inflated(limits.margin))
    shape.emplace_back(p.x(), p.y());
  system->changeRobotShape(shape);
  system->initialize();
  return system;
}

}  // namespace semantic_driving
