#include <semantic_driving/ReactiveNavigator.h>

#include "ReactiveSystem.h"

namespace semantic_driving {

using semantic_planning::PathPoint;

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

}  // namespace semantic_driving
