#include "DriveLoop.h"

#include <mrpt/core/Clock.h>
#include <semantic_driving/ObstacleSensing.h>

#include <cmath>
#include <cstdio>

#include "measuring/Stopwatch.h"

namespace simulated_drive {

using measuring::Stopwatch;
using namespace semantic_driving;
using namespace semantic_planning;
using mrpt::math::TPose2D;

namespace {

constexpr double kEpoch = 1704067200;  // 2024-01-01, UTC
constexpr double kSameTime = 1e-6;     // s

ReactiveNavigator::Options reactiveOf(const DriveConfig& config,
                                      const std::filesystem::path& navlogs) {
  ReactiveNavigator::Options options;
  options.config = config.reactive;
  options.footprint = config.planner.vehicle.footprint;
  options.margin = config.drive.margin;
  options.maxSpeed = config.drive.maxSpeed;
  options.turningRadius = config.drive.turningRadius;
  options.logFolder = navlogs;
  return options;
}

std::string meters(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f m", value);
  return text;
}

void setClock(double seconds) {
  mrpt::Clock::setActiveClock(mrpt::Clock::Source::Simulated);
  mrpt::Clock::setSimulatedTime(mrpt::Clock::fromDouble(kEpoch + seconds));
}

}  // namespace

synthetic_world::Footprint trueFootprint(const VehicleOptions& vehicle) {
  synthetic_world::Footprint footprint;
  footprint.outline.assign(vehicle.footprint.begin(), vehicle.footprint.end());
  footprint.height = vehicle.height;
  footprint.clearance = vehicle.stepHeight;
  return footprint;
}

DriveLoop::DriveLoop(const DriveConfig& config, synthetic_world::World& world,
                     const colored_graph::ClassOrder& order, const TPose2D& start,
                     const TPose2D& goal, Events events,
                     std::unique_ptr<semantic_octree::StoredMap> map, std::filesystem::path navlogs)
    : m_config(config),
      m_world(world),
      m_events(std::move(events)),
      m_start(start),
      m_goal(goal),
      m_sensors(config.sensors, false),
      m_mapper(map ? std::make_unique<Mapper>(config, order, std::move(map))
                   : std::make_unique<Mapper>(config, order)),
      m_guide(std::make_unique<DriveGuide>(config.guide, m_mapper->planner(), goal)),
      m_controller(config.drive, reactiveOf(config, navlogs)),
      m_movers(config.movers, synthetic_world::classTable()),
      m_robot(start, config.drive),
      m_pose(start, config.pose, config.slam, m_movers.isMover(), config.sensors.seed),
      m_state(m_robot.state()),
      m_footprint(trueFootprint(config.planner.vehicle)) {
  if (!config.pose.isExact() && config.pose.correct && !m_mapper->map().empty())
    m_pose.setReference(m_mapper->map());
  m_controller.setClassSpeeds(config.drive.classSpeeds(order));
  const auto classes = synthetic_world::classTable().size() + 1;
  m_record.drivenPerClass.resize(classes);
  m_record.plannedPerClass.resize(classes);
  m_record.exactPose = config.pose.isExact();
  setClock(0);
}

Eigen::Isometry3d DriveLoop::T_world_robot() const {
  const TPose2D& p = m_robot.state().pose;
  return m_world.poseOnGround(p.x, p.y, p.phi);
}

/** Height, roll and pitch are known. */
Eigen::Isometry3d DriveLoop::T_level_robot() const {
  return isometry(m_robot.state().pose).inverse() * T_world_robot();
}

Eigen::Isometry3d DriveLoop::T_map_robot() const {
  return m_record.exactPose ? T_world_robot() : isometry(state().pose) * T_level_robot();
}

double DriveLoop::groundZ() const {
  const TPose2D& p = m_robot.state().pose;
  return m_world.groundHeight(p.x, p.y);
}

const DriveRecord& DriveLoop::run() {
  while (!isOver()) {
    setClock(m_time);
    m_world.setMovables(m_events.at(m_world, m_time));
    if (m_time - m_lookedAt >= m_config.sensors.period - kSameTime) {
      m_lookedAt = m_time;
      m_guidesNext = true;
      sense();
    }
    if (isInserting() && m_time - m_insertingFrom >= m_config.mappingLatency - kSameTime)
      endInsertion();
    if (m_guidesNext && !isInserting()) guide();
    drive();
    for (DriveObserver* o : m_observers) o->onDriven(*this);
    m_time += m_config.controlPeriod;
  }
  if (isInserting()) endInsertion();
  m_record.replans = m_guide->replans();
  m_record.refusal = m_guide->refusal();
  for (DriveObserver* o : m_observers) o->onFinished(*this);
  return m_record;
}

void DriveLoop::sense() {
  if (!m_events.sensorsWork(m_time)) return;
  Stopwatch watch(measuring::TimeOf::Thread);
  const std::vector<Observation> seen = m_sensors.sense(m_world, T_world_robot());
  note("simulate", watch.lap());
  if (!isInserting()) insert(seen);
  Stopwatch following(measuring::TimeOf::Thread);
  for (const Observation& o : seen) m_movers.see(o.cloud, T_map_robot() * o.T_robot_sensor);
  m_movers.update(m_time);
  note("movers", following.lap());
  for (DriveObserver* o : m_observers) o->onSensed(*this, seen);
}

/** Begins to. */
void DriveLoop::insert(const std::vector<Observation>& seen) {
  m_mapper->age(m_insertedFrom < 0 ? 0 : m_time - m_insertedFrom);
  focus();
  m_insertingFrom = m_time;
  const auto insertNow = insertion(seen);
  if (m_config.mappingLatency == 0) {
    m_inserting = std::async(std::launch::deferred, insertNow);
    return endInsertion();
  }
  m_before =
      knownObstacles(m_config.obstacles.radius + m_config.drive.maxSpeed * m_config.mappingLatency);
  m_beforeAt = state().pose;
  m_inserting = std::async(std::launch::async, insertNow);
}

/** Where the robot is when it sees that is told now, the map may be filled later. */
std::function<StageTimes()> DriveLoop::insertion(const std::vector<Observation>& seen) {
  if (m_record.exactPose || !m_config.pose.correct)
    return [this, seen, T = T_map_robot()] { return m_mapper->insert(seen, T); };
  Stopwatch watch(measuring::TimeOf::Thread);
  const auto added = m_pose.correct(seen, T_level_robot());
  m_state.pose = m_pose.pose();
  note("localize", watch.lap());
  return [this, seen, added] { return m_mapper->insert(seen, added, m_pose.slam()); };
}

void DriveLoop::endInsertion() {
  for (const auto& [stage, ms] : m_inserting.get()) note(stage, ms);
  m_record.leaves.push_back(static_cast<double>(m_mapper->numCompressedLeaves()));
  m_insertedFrom = m_insertingFrom;
}

Mapper& DriveLoop::waitedFor() const {
  if (isInserting()) m_inserting.wait();
  return *m_mapper;
}

void DriveLoop::focus() {
  if (!m_config.focus.isOn()) return;
  Stopwatch watch(measuring::TimeOf::Thread);
  const PathTracker& tracker = m_controller.tracker();
  const Eigen::Vector3d place(state().pose.x, state().pose.y, groundZ());
  m_mapper->focus(regionsAhead(tracker.path(), tracker.progress(), place, m_config.focus));
  note("focus", watch.lap());
}

void DriveLoop::guide() {
  Stopwatch watch(measuring::TimeOf::Thread);
  m_guidesNext = false;
  m_guide->update(state(), groundZ(), m_controller, m_time);
  const double replan = watch.lap();
  note("replan", replan);
  if (m_insertedFrom >= m_lookedAt)
    note("insert+update+replan", (m_config.focus.isOn() ? m_record.times["focus"].back() : 0) +
                                     m_record.times["insert"].back() +
                                     m_record.times["update"].back() + replan);
}

/** Cells of the compressed tree are in the way as a whole. Where the robot stands before them the
 * voxels of the full tree count, for as long as it takes to get by. */
bool DriveLoop::wantsFineObstacles() {
  constexpr double kFor = 5;  // s
  if (m_controller.stoppedFor(m_time) >= m_config.guide.patience) m_fineUntil = m_time + kFor;
  return !m_config.compressedObstacles || m_time < m_fineUntil;
}

/** What of the map is in the way, in the robot's frame. */
ObstaclePoints DriveLoop::knownObstacles(double radius) {
  ObstacleOptions options = m_guide->obstacles(m_config.obstacles);
  options.radius = radius;
  return m_mapper->obstacles(state().pose, groundZ(), options, wantsFineObstacles());
}

/** The same; while a scan is inserted, as it was known before. */
ObstaclePoints DriveLoop::obstacles() {
  const double radius = m_config.obstacles.radius;
  return isInserting() ? seenFrom(m_before, m_beforeAt, state().pose, radius)
                       : knownObstacles(radius);
}

void DriveLoop::drive() {
  Stopwatch watch(measuring::TimeOf::Thread);
  const ObstaclePoints around = obstacles();
  note("obstacles", watch.lap());
  const DriveCommand command =
      m_controller.step(state(), around, m_time - m_insertedFrom, m_time, m_movers.at(m_time));
  note("react", watch.lap());
  addRow();
  move(command);
}

void DriveLoop::move(const DriveCommand& command) {
  const TPose2D before = m_robot.state().pose;
  m_robot.drive(command, m_config.controlPeriod);
  m_state = m_robot.state();
  if (m_record.exactPose) return;
  m_pose.move(m_state.pose - before);
  m_state.pose = m_pose.pose();
}

void DriveLoop::addRow() {
  DriveRow row;
  row.time = m_time;
  row.pose = m_robot.state().pose;
  row.believed = state().pose;
  row.odometry = m_record.exactPose ? row.pose : m_pose.odometry();
  row.z = groundZ();
  row.speed = state().speed;
  row.turn = state().turn;
  row.classId = m_world.groundClass(row.pose.x, row.pose.y);
  row.clearance = m_world.clearance(m_footprint, row.pose.x, row.pose.y, row.pose.phi);
  row.target = m_guide->target();
  row.driver = m_controller.driver();
  const PathTracker& tracker = m_controller.tracker();
  if (!tracker.path().empty()) row.offset = tracker.offset();
  std::optional<semantic_types::ClassId> planned;
  if (!tracker.path().empty()) {
    const PathPoint p = tracker.path().at(tracker.progress());
    row.bend = p.curvature;
    planned = m_world.groundClass(p.x, p.y);
  }
  m_record.add(row, planned, std::abs(row.speed) * m_config.controlPeriod);
}

void DriveLoop::endAtGoal() {
  const TPose2D& p = m_robot.state().pose;
  const TPose2D& goal = m_guide->goal();
  const double off = std::hypot(p.x - goal.x, p.y - goal.y);
  const bool arrived = m_record.exactPose || off < m_config.guide.atGoal;
  const bool refused = m_guide->refusal().has_value();
  m_record.end = !arrived ? DriveEnd::Astray : refused ? DriveEnd::Nearest : DriveEnd::Arrived;
  if (refused) m_record.reason = m_guide->refusal()->reason;
  if (!arrived) m_record.reason = "it believes to have arrived, but is " + meters(off) + " off";
}

bool DriveLoop::isOver() {
  if (m_guide->arrived(state(), m_controller)) {
    endAtGoal();
    return true;
  }
  if (m_guide->gaveUp() && std::abs(state().speed) < semantic_driving::DriveOptions::kAtRest) {
    m_record.end = DriveEnd::Unreachable;
    m_record.reason = m_guide->reason();
    return true;
  }
  if (m_stop && m_stop()) {
    m_record.end = DriveEnd::Stopped;
    m_record.reason = "it was stopped on the way";
    return true;
  }
  if (m_time < m_config.timeLimit) return false;
  m_record.reason = "the time is over";
  return true;
}

}  // namespace simulated_drive
