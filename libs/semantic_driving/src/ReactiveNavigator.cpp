#include <semantic_driving/ReactiveNavigator.h>

#include <mrpt/config/CConfigFile.h>
#include <mrpt/nav/reactive/CReactiveNavigationSystem.h>
#include <mrpt/nav/reactive/CReactiveNavigationSystem3D.h>
#include <strict_files/TextFile.h>

#include <iomanip>
#include <limits>
#include <sstream>

#include "ReactiveSystem.h"

namespace semantic_driving {

using mrpt::config::CConfigFile;
using mrpt::nav::CReactiveNavigationSystem;
using mrpt::nav::CReactiveNavigationSystem3D;
using semantic_planning::PathPoint;
using Options = ReactiveNavigator::Options;

struct ReactiveNavigator::Navigation {
  explicit Navigation(const Options& options)
      : slices(options.slices), system(makeReactiveSystem(robot, options, scratch.path())) {}

  std::vector<Slice> slices;
  ScratchFolder scratch;
  RobotInterface robot;
  std::unique_ptr<mrpt::nav::CAbstractPTGBasedReactive> system;
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
  m_navigation->robot.blocked = false;
  m_navigation->started = true;
  m_navigation->system->resetNavError();
  m_navigation->system->navigateWaypoints(sequence);
}

void ReactiveNavigator::cancel() {
  m_navigation->started = false;
  m_navigation->system->cancel();
}

DriveCommand ReactiveNavigator::step(const DriveState& state, const ObstaclePoints& obstacles,
                                     double seconds) {
  ObstaclePoints3 points;
  const auto add = [&](double z) {
    for (const Eigen::Vector2d& o : obstacles) points.emplace_back(o.x(), o.y(), z);
  };
  double below = 0;
  for (const Slice& slice : m_navigation->slices) {
    add(below + slice.height / 2);
    below += slice.height;
  }
  if (m_navigation->slices.empty()) add(0.5);
  return step(state, points, seconds);
}

DriveCommand ReactiveNavigator::step(const DriveState& state, const ObstaclePoints3& obstacles,
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

const std::string kSection = "CReactiveNavigationSystem", kSection3D = kSection + "3D";

/** Does not print how long everything took when it is gone. */
template <class System>
class Quiet : public System {
 public:
  using System::System;
  ~Quiet() override { this->m_timlog_delays.clear(true); }
};

void writeLimits(CConfigFile& file, const Options& options) {
  const double turn = options.maxSpeed / options.turningRadius * 180 / M_PI;
  file.write("CAbstractPTGBasedReactive", "robotMax_V_mps", options.maxSpeed);
  file.write("CAbstractPTGBasedReactive", "robotMax_W_degps", turn);
  const int count = file.read_int(kSection, "PTG_COUNT", 0, true);
  for (int i = 0; i < count; ++i) {
    const std::string name = "PTG" + std::to_string(i);
    file.write(kSection, name + "_v_max_mps", options.maxSpeed);
    file.write(kSection, name + "_w_max_dps", turn);
  }
}

/** MRPT has another section for shapes of slices, and counts the trajectories from 1 there. */
std::string keyOf3D(const std::string& key) {
  const auto end = key.find('_');
  if (key.rfind("PTG", 0) != 0 || end == std::string::npos || end == 3) return key;
  const std::string number = key.substr(3, end - 3);
  if (number.find_first_not_of("0123456789") != std::string::npos) return key;
  return "PTG" + std::to_string(std::stoi(number) + 1) + key.substr(end);
}

void writeSlices(CConfigFile& file, const Options& options) {
  file.write(kSection3D, "HEIGHT_LEVELS", static_cast<int>(options.slices.size()));
  for (std::size_t i = 0; i < options.slices.size(); ++i) {
    const std::string level = "LEVEL" + std::to_string(i + 1);
    std::ostringstream x, y;
    const strict_files::ClassicNumbers classicX(x), classicY(y);
    for (const Eigen::Vector2d& p : options.slices[i].outline.inflated(options.margin))
      x << p.x() << ' ', y << p.y() << ' ';
    file.write(kSection3D, level + "_HEIGHT", options.slices[i].height);
    file.write(kSection3D, level + "_VECTORX", x.str());
    file.write(kSection3D, level + "_VECTORY", y.str());
  }
}

void writeSection3D(CConfigFile& file, const Options& options) {
  std::vector<std::string> keys;
  file.getAllKeys(kSection, keys);
  for (const std::string& key : keys)
    file.write(kSection3D, keyOf3D(key), file.read_string(kSection, key, ""));
  writeSlices(file, options);
}

template <class System>
std::unique_ptr<System> loaded(RobotInterface& robot, const Options& options,
                               const CConfigFile& file, const std::filesystem::path& tables) {
  auto system = std::make_unique<Quiet<System>>(robot, false);
  system->logging_enable_console_output = false;
  system->setLogFileDirectory(options.logFolder.string());
  system->enableLogFile(!options.logFolder.empty());
  system->enableRethrowNavExceptions(true);
  system->loadConfigFile(file);
  // MRPT 2.5.8 does not read the key of this name.
  system->params_abstract_ptg_navigator.ptg_cache_files_directory = tables.string();
  return system;
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
    RobotInterface& robot, const Options& options, const std::filesystem::path& tables) {
  if (!std::filesystem::exists(options.config))
    throw std::runtime_error(options.config.string() + ": no such file");
  CConfigFile file(options.config.string());
  writeLimits(file, options);
  completeHolonomicFactors(file, kHolonomicFactors);
  if (!options.slices.empty()) writeSection3D(file, options);
  file.discardSavingChanges();  // or MRPT writes the file anew
  robot.logging_enable_console_output = false;
  std::unique_ptr<mrpt::nav::CAbstractPTGBasedReactive> system;
  if (options.slices.empty()) {
    auto flat = loaded<CReactiveNavigationSystem>(robot, options, file, tables);
    mrpt::math::CPolygon shape;
    for (const Eigen::Vector2d& p : options.footprint.inflated(options.margin))
      shape.emplace_back(p.x(), p.y());
    flat->changeRobotShape(shape);
    system = std::move(flat);
  } else {
    system = loaded<CReactiveNavigationSystem3D>(robot, options, file, tables);
  }
  system->initialize();
  return system;
}

}  // namespace semantic_driving
