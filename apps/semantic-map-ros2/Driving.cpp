#include "Driving.h"

#include <mrpt/core/Clock.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/planner/OrderFile.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

#include "Terminal.h"
#include "measuring/Measuring.h"

namespace semantic_map_ros2 {

void GroundGrid::publish(ros2::Stamp stamp, const Eigen::Isometry3d& T_map_robot) {
  if (!m_writes.isRead()) return;
  const auto changed = m_costs.follow(T_map_robot);
  if (!m_costs.box()) return;
  const bool isNew = !m_box || !(*m_box == *m_costs.box()) || m_writes.hasNewReader();
  m_box = m_costs.box();
  const ros2::Header header = ros2::headerOf(stamp, m_frame);
  if (isNew || (changed && m_writesUpdates.readers() < m_writes.readers()))
    publishAll(header);
  else if (changed)
    publishUpdate(header, *changed);
}

void GroundGrid::publishAll(const ros2::Header& header) {
  ros2::OccupancyGrid message{};
  message.header = header;
  message.info.map_load_time = header.stamp;
  message.info.resolution = static_cast<float>(m_costs.voxelSize());
  message.info.width = std::uint32_t(m_box->width());
  message.info.height = std::uint32_t(m_box->height());
  message.info.origin.position.x = m_costs.borderOf(m_box->low.x);
  message.info.origin.position.y = m_costs.borderOf(m_box->low.y);
  message.info.origin.orientation.w = 1;
  ros2::refer(message.data, m_costs.cells());
  m_writes.write(message);
}

void GroundGrid::publishUpdate(const ros2::Header& header, const Box& changed) {
  std::vector<std::uint8_t> cells;
  for (int y = changed.low.y; y <= changed.high.y; ++y)
    for (int x = changed.low.x; x <= changed.high.x; ++x) cells.push_back(m_costs.at({x, y}));
  ros2::OccupancyGridUpdate message{};
  message.header = header;
  message.x = changed.low.x - m_box->low.x, message.y = changed.low.y - m_box->low.y;
  message.width = std::uint32_t(changed.width()), message.height = std::uint32_t(changed.height());
  ros2::refer(message.data, cells);
  m_writesUpdates.write(message);
}

using mrpt::math::TPose2D;
using semantic_navigation::Navigator;
using semantic_planning::PathPoint;

TPose2D planar(const Eigen::Isometry3d& T) {
  return {T.translation().x(), T.translation().y(), std::atan2(T(1, 0), T(0, 0))};
}

Driving::Driving(ros2::Node& node, const Parameters& parameters, semantic_slam::Mapper& mapper,
                 const colored_graph::ClassOrder& order)
    : m_mapper(mapper),
      m_order(order),
      m_options(parameters.navigation.planner),
      m_frame(parameters.node.mapFrame),
      m_writesPath(node, "plan", {true, false, 10}) {
  if (!parameters.node.drive) return;
  m_navigator.emplace(mapper, order, parameters.navigation);
  m_writesCommand.emplace(node, "cmd_vel", ros2::Qos{true, false, 1});
  m_exploring = parameters.navigation.explore;
  m_exploring.sensor.range = parameters.insertion.scan.maxRange;
  const auto& abstraction = parameters.abstraction;
  if (abstraction.isSet()) m_weights = abstraction.forClasses(mapper.map().classes()).weights;
}

void Driving::setGoal(const TPose2D& goal) {
  m_said.clear();
  if (m_navigator) return m_navigator->setGoal(goal);
  m_goal = goal;
  m_isNew = true;
}

std::string Driving::explore(bool isToExplore) {
  if (!m_navigator) return "the robot does not drive";
  if (m_solidAngle == 0) return "nothing was seen yet";
  m_said.clear();
  auto exploring = m_exploring;
  exploring.sensorHeight += m_navigator->frameHeight().value_or(0);
  if (isToExplore)
    m_navigator->explore(m_weights, exploring);
  else
    m_navigator->endExploring();
  return {};
}

/** A shape with beams in equal steps, as many as points came, but no more than it takes to meet
 * what is near. It is made once, and swept at each place. */
void Driving::learnSensor(const semantic_slam::SensorScan& scan) {
  constexpr double kDegrees = 180 / M_PI, kGap = 30, kMostBeams = 8000;
  constexpr std::size_t kSome = 2000;  // points that are looked at
  std::vector<double> up, around, ranges;
  const auto& points = scan.cloud.points;
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / kSome) {
    const Eigen::Vector3d ray = scan.T_robot_sensor.linear() * points[i].cast<double>();
    up.push_back(std::atan2(ray.z(), std::hypot(ray.x(), ray.y())) * kDegrees);
    around.push_back(std::atan2(ray.y(), ray.x()) * kDegrees);
    ranges.push_back(ray.norm());
  }
  if (up.empty()) return;
  std::sort(around.begin(), around.end());
  double gap = around.front() + 360 - around.back();
  for (std::size_t i = 1; i < around.size(); ++i) gap = std::max(gap, around[i] - around[i - 1]);
  const double width = gap < kGap ? 360 : 360 - gap;
  const double lowest = measuring::quantile(up, 0.01), highest = measuring::quantile(up, 0.99);
  const double span = std::max(1.0, highest - lowest);
  if (width * span <= m_solidAngle) return;
  m_solidAngle = width * span;
  const double beams = std::min(kMostBeams, static_cast<double>(points.size()) * 360 / width);
  const int rings = std::max(1, static_cast<int>(std::sqrt(beams * span / 360)));
  double& range = m_exploring.sensor.range;
  if (!(range > 0)) range = measuring::quantile(ranges, 0.99);
  m_exploring.sensor = {range, lowest, highest, width, rings, static_cast<int>(beams) / rings};
  m_exploring.sensorHeight = scan.T_robot_sensor.translation().z();
}

void Driving::plan(const Eigen::Isometry3d& T_map_robot, ros2::Stamp stamp) {
  if (m_navigator || !m_goal) return;
  auto& map = m_mapper.map();
  if (!m_planner) {
    if (!hasAbstraction(map)) setAbstraction(map, semantic_planning::abstractionFor(m_order));
    m_planner.emplace(map, m_order, m_options);
  }
  m_planner->update();
  const TPose2D start = planar(T_map_robot);
  m_height.look(m_planner->ground(), m_options.vehicle, T_map_robot);
  std::optional<double> z;
  if (m_height.meters()) z = m_height.onGround(T_map_robot).translation().z();
  const auto plan = m_isNew || !m_planner->hasPlanned() ? m_planner->plan(start, *m_goal, z)
                                                        : m_planner->replan(start, z);
  m_isNew = false;
  const std::string what = plan.found() ? "a path was found" : "no path: " + plan.reason;
  if (std::exchange(m_said, what) != what) notes() << "Goal: " << what << std::endl;
  publish(plan.path, stamp);
}

void Driving::step(const std::optional<semantic_navigation::RobotState>& robot, ros2::Stamp stamp) {
  if (!m_navigator) return;
  if (!robot) return halt();
  mrpt::Clock::setActiveClock(mrpt::Clock::Source::Simulated);
  mrpt::Clock::setSimulatedTime(mrpt::Clock::fromDouble(ros2::secondsOf(stamp)));
  m_navigator->update(*robot);
  const auto command = m_navigator->step(ros2::secondsOf(stamp));
  sayStatus();
  if (!m_navigator->isDriving()) return halt();
  ros2::Twist message{};
  message.linear.x = command.speed, message.angular.z = command.turn;
  m_moves = true;
  m_writesCommand->write(message);
  const auto& path = m_navigator->controller().tracker().path().points();
  const auto same = [](const PathPoint& a, const PathPoint& b) { return a.x == b.x && a.y == b.y; };
  if (!std::equal(path.begin(), path.end(), m_published.begin(), m_published.end(), same))
    publish(m_published = path, stamp);
}

void Driving::halt() {
  if (m_navigator && std::exchange(m_moves, false)) m_writesCommand->write(ros2::Twist{});
}

void Driving::sayStatus() {
  using Status = Navigator::Status;
  const Status status = m_navigator->status();
  std::string what;
  if (status == Status::Arrived) what = "the robot is there";
  if (status == Status::Nearest) what = "the robot is as near as it can: " + m_navigator->reason();
  if (status == Status::Unreachable) what = "the robot gave up: " + m_navigator->reason();
  if (status == Status::Explored) what = "the robot explored; " + m_navigator->reason();
  if (!what.empty() && std::exchange(m_said, what) != what)
    notes() << "Goal: " << what << std::endl;
}

void Driving::publish(const std::vector<PathPoint>& path, ros2::Stamp stamp) {
  std::vector<geometry_msgs_msg_dds__PoseStamped_> poses;
  const ros2::Header header = ros2::headerOf(stamp, m_frame);
  for (const PathPoint& p : path)
    poses.push_back(
        {header, {{p.x, p.y, p.z}, {0, 0, std::sin(p.heading / 2), std::cos(p.heading / 2)}}});
  ros2::Path message{};
  message.header = header;
  ros2::refer(message.poses, poses);
  m_writesPath.write(message);
}

}  // namespace semantic_map_ros2
