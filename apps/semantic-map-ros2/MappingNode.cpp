#include "MappingNode.h"

#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/planner/OrderFile.h>
#include <strict_files/Words.h>

#include <cmath>
#include <iomanip>
#include <ostream>

#include "Terminal.h"
#include "measuring/Measuring.h"

namespace semantic_map_ros2 {

using namespace std::chrono_literals;
using Eigen::Isometry3d;
using std::chrono::steady_clock;

namespace {

constexpr auto kStep = 100ms, kLook = 50ms, kWait = 20ms;
constexpr std::size_t kMostLatencies = 10'000;
constexpr double kTransformsAge = 1;  // s: with an older one it is not known where the robot is

/** x, y and heading of a pose. */
Isometry3d upright(const Isometry3d& T) {
  const auto pose = planar(T);
  return Eigen::Translation3d(pose.x, pose.y, 0) *
         Eigen::AngleAxisd(pose.phi, Eigen::Vector3d::UnitZ());
}

bool passed(steady_clock::time_point& since, steady_clock::duration period) {
  const auto now = steady_clock::now();
  if (now - since < period) return false;
  since = now;
  return true;
}

}  // namespace

MappingNode::MappingNode(const Parameters& parameters, const ros2::Arguments& arguments,
                         semantic_octree::SemanticOcTree& map, std::function<void()> save)
    : m_parameters(parameters),
      m_node("semantic_map", arguments),
      m_clock(parameters.node.useSimTime),
      m_queue(m_parameters.node, {[this](const auto& target, const auto& source, Stamp stamp) {
                                    return m_frames.find(target, source, stamp);
                                  },
                                  [this] { return m_clock.now(); },
                                  [this](const std::string& what) { m_complaints.say(what); }}),
      m_mapper(map, parameters.mapping()),
      m_messages(m_node, map, parameters.node.mapFrame),
      m_tree(m_node, map, parameters.node.mapFrame),
      m_writesTransforms(m_node, "/tf", {true, false, 100}),
      m_save(std::move(save)),
      m_scanClock(parameters.insertion.maxGap),
      m_sensors(m_node, m_parameters.node, map.classes(), parameters.insertion.conversion, m_clock,
                m_frames, m_queue, m_complaints),
      m_goals(m_node, "goal_pose"),
      m_initialPoses(m_node, "initialpose"),
      m_explorings(m_node, "~/explore"),
      m_saves(m_node, "~/save") {
  const NodeOptions& node = m_parameters.node;
  if (node.order.empty()) return;
  const auto order = semantic_planning::loadClassOrder(node.order, map.classes());
  m_driving.emplace(m_node, m_parameters, m_mapper, order);
  m_grid.emplace(m_node,
                 ground_costs::GroundCosts(map, order, m_parameters.navigation.planner,
                                           node.costsOf(order.ranks())),
                 node.mapFrame);
}

void MappingNode::run(const StopRequest& stop) {
  notes() << "Waiting for scans on " << m_node.topic("points") << ", " << m_node.topic("scan")
          << " or " << m_node.topic("depth/image") << "; Ctrl-C ends and saves" << std::endl;
  while (!stop.pending()) {
    m_queue.wait(kWait);
    while (!stop.pending() && insertNext()) serve();
    serve();
  }
  if (m_driving) m_driving->halt();
  m_queue.close();
  while (insertNext()) continue;
  if (m_driving && m_driving->navigator()) m_driving->navigator()->finish();
  m_mapper.finish();
}

/** What fails costs no map. */
void MappingNode::serve() try {
  look();
  publish();
} catch (const std::exception& e) {
  if (m_driving) m_driving->halt();
  m_complaints.say(strict_files::messageOf(e));
}

/** What is due whether scans come or not. */
void MappingNode::look() {
  hear();
  if (m_driving && passed(m_steppedAt, kStep)) {
    const auto latest =
        m_frames.latest(m_parameters.node.worldFrame(), m_parameters.node.baseFrame);
    const Stamp now = m_clock.now();
    const bool isKnown = latest && std::abs(ros2::secondsOf(now - *latest)) < kTransformsAge;
    m_driving->step(isKnown ? robotAt(*latest) : std::nullopt, now);
  }
  if (!passed(m_lookedAt, kLook)) return;
  for (const std::string& problem : m_node.look()) m_complaints.say(problem);
  publishCorrection();
}

void MappingNode::hear() {
  if (const auto goal = m_goals.take()) onGoal(*goal);
  if (const auto pose = m_initialPoses.take()) onInitialPose(*pose);
  if (const auto exploring = m_explorings.take()) onExploring(exploring->data);
  if (m_saves.take()) try {
      if (m_driving && m_driving->navigator()) m_driving->navigator()->finish();
      m_save();
    } catch (const std::exception& e) {
      m_complaints.say(strict_files::messageOf(e));
    }
}

void MappingNode::onExploring(bool isToExplore) {
  const std::string problem = m_driving ? m_driving->explore(isToExplore) : "there is no order";
  if (!problem.empty()) m_complaints.say("it cannot explore: " + problem);
}

void MappingNode::onGoal(const ros2::PoseStamped& message) {
  if (!m_driving) return m_complaints.say("a goal came, but no order says what to drive on");
  const auto T_map_goal = inMap(message.header, message.pose, "a goal");
  if (!T_map_goal) return;
  m_driving->setGoal(planar(*T_map_goal));
  if (m_T_world_robot) m_driving->plan(m_mapper.T_map_odometry() * *m_T_world_robot, m_stamp);
}

void MappingNode::onInitialPose(const ros2::PoseWithCovarianceStamped& message) {
  if (!m_parameters.node.slam)
    return m_complaints.say("an initial pose came, but without slam /tf says where the robot is");
  const auto T_map_robot = inMap(message.header, message.pose.pose, "an initial pose");
  const auto latest = m_frames.latest(m_parameters.node.worldFrame(), m_parameters.node.baseFrame);
  const auto T_odometry_robot = m_frames.find(
      m_parameters.node.worldFrame(), m_parameters.node.baseFrame, latest.value_or(m_stamp));
  if (!T_map_robot) return;
  if (!T_odometry_robot.T_target_source)
    return m_complaints.say("an initial pose came before odometry", T_odometry_robot.problem);
  if (m_driving && m_driving->navigator()) m_driving->navigator()->mapper();  // waits
  // x, y and heading are those of the pose; height and tilt stay.
  const Isometry3d& T_odometry = *T_odometry_robot.T_target_source;
  const Isometry3d T_before = m_mapper.T_map_odometry() * T_odometry;
  m_mapper.relocalize(upright(*T_map_robot) * upright(T_before).inverse() * T_before *
                      T_odometry.inverse());
  m_correctedAt.reset();
  notes() << "The robot is where an initial pose has it" << std::endl;
}

std::optional<Isometry3d> MappingNode::inMap(const ros2::Header& header,
                                             const geometry_msgs_msg_dds__Pose_& pose,
                                             const std::string& what) {
  const std::string frame = ros2::textOf(header.frame_id), &map = m_parameters.node.mapFrame;
  const auto& [p, q] = pose;
  const Isometry3d T_frame_pose =
      Eigen::Translation3d(p.x, p.y, p.z) * Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  point_fields::Frames::Answer T_map_frame{Isometry3d::Identity(), {}};
  if (frame != map)
    T_map_frame = m_frames.find(map, frame, m_frames.latest(map, frame).value_or(0));
  if (T_map_frame.T_target_source && T_frame_pose.matrix().allFinite())
    return *T_map_frame.T_target_source * T_frame_pose;
  m_complaints.say(what + " cannot be understood", T_map_frame.problem);
  return std::nullopt;
}

bool MappingNode::insertNext() {
  return m_queue.insertNext(
      [this](const WaitingScan& scan, semantic_slam::SensorScan seen,
             const Isometry3d& T_world_robot) { insert(scan, std::move(seen), T_world_robot); });
}

void MappingNode::insert(const WaitingScan& scan, semantic_slam::SensorScan one,
                         const Isometry3d& T_world_robot) {
  const std::vector<semantic_slam::SensorScan> seen = {std::move(one)};
  const auto stamp = mrpt::Clock::fromDouble(ros2::secondsOf(scan.stamp));
  if (auto* navigator = m_driving ? m_driving->navigator() : nullptr) {
    navigator->update(*robotAt(scan.stamp));
    navigator->see(seen, ros2::secondsOf(scan.stamp));
    m_driving->learnSensor(seen[0]);
  } else {
    const double seconds = m_seconds + m_scanClock.secondsUntil(stamp);
    m_mapper.insert(seen, m_mapper.locate(seen, T_world_robot, seconds), seconds);
    m_seconds = seconds;
  }
  m_scanClock.note(stamp);
  ++m_scans;
  m_stamp = scan.stamp;
  m_T_world_robot = T_world_robot;
  m_isNew = true;
  m_came.push_back(scan.came);
  std::ostream& said = m_scans == 1 ? notes() : details();  // scans come
  said << scan.topic << ": " << seen[0].cloud.size() << " points inserted" << std::endl;
}

std::optional<semantic_navigation::RobotState> MappingNode::robotAt(Stamp stamp) const {
  const auto T = m_frames.find(m_parameters.node.worldFrame(), m_parameters.node.baseFrame, stamp)
                     .T_target_source;
  if (!T) return std::nullopt;
  const Speeds speeds = m_sensors.speeds();
  return semantic_navigation::RobotState{{planar(*T), speeds.forward, speeds.turn}, *T};
}

void MappingNode::publish() {
  const bool isAsked = m_tree.isAsked() || (m_grid && m_grid->isAsked());
  if (!m_isNew && !(isAsked && m_scans > 0)) return;
  const auto period = std::chrono::duration<double>(m_parameters.node.publishPeriod);
  if (!passed(m_publishedAt, std::chrono::duration_cast<steady_clock::duration>(period))) return;
  m_isNew = false;
  if (m_driving && m_driving->navigator()) m_driving->navigator()->mapper();  // waits
  m_messages.publish(m_stamp);
  if (hasAbstraction(m_mapper.map()))
    m_tree.publish(m_stamp);
  else if (m_tree.isRead())
    m_complaints.say("~/compressed: the map has no abstraction; abstraction.relevant gives it one");
  const Isometry3d T_map_robot = m_mapper.T_map_odometry() * *m_T_world_robot;
  publishCorrection();
  if (m_grid) m_grid->publish(m_stamp, T_map_robot);
  if (m_driving) m_driving->plan(T_map_robot, m_stamp);
  for (const auto came : m_came)
    m_latencies.push_back(
        std::chrono::duration<double, std::milli>(steady_clock::now() - came).count());
  m_came.clear();
  if (m_latencies.size() > 2 * kMostLatencies)
    m_latencies.erase(m_latencies.begin(), m_latencies.end() - kMostLatencies);
}

/** What SLAM says holds until the next scan: for as long as odometry's transforms are known. */
void MappingNode::publishCorrection() {
  const bool isKnown = m_scans > 0 || !m_mapper.T_map_odometry().isApprox(Isometry3d::Identity());
  if (!m_parameters.node.slam || !isKnown) return;
  const auto latest = m_frames.latest(m_parameters.node.worldFrame(), m_parameters.node.baseFrame);
  const Stamp stamp = std::max(latest.value_or(m_stamp), m_stamp);
  if (m_correctedAt && *m_correctedAt == stamp) return;
  m_correctedAt = stamp;
  const Isometry3d& T = m_mapper.T_map_odometry();
  const Eigen::Quaterniond q(T.linear());
  std::vector<ros2::TransformStamped> transforms = {
      {ros2::headerOf(stamp, m_parameters.node.mapFrame),
       ros2::textOf(m_parameters.node.worldFrame()),
       {{T(0, 3), T(1, 3), T(2, 3)}, {q.x(), q.y(), q.z(), q.w()}}}};
  ros2::TFMessage message{};
  ros2::refer(message.transforms, transforms);
  m_writesTransforms.write(message);
}

void MappingNode::saySummary() const {
  m_complaints.sum();
  notes() << m_scans << " scans inserted, " << m_queue.leftOut() << " left out";
  if (!m_latencies.empty())
    notes() << std::fixed << std::setprecision(0)
            << "; from a scan's message to the map's: " << measuring::quantile(m_latencies, 0.5)
            << " ms (median), " << measuring::quantile(m_latencies, 0.95) << " ms (95 %)";
  notes() << std::endl;
}

}  // namespace semantic_map_ros2
