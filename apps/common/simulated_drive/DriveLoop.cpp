#include "DriveLoop.h"

#include <mrpt/core/Clock.h>
#include <mrpt/core/format.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_types/ClassTable.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/Solids.h>

#include <algorithm>
#include <cmath>

#include "measuring/Measuring.h"
#include "poses/Poses.h"
#include "synthetic_rawlog/Observations.h"

namespace simulated_drive {

using poses::parseNumbers;
using synthetic_world::Solids;
using synthetic_world::World;

namespace {

Eigen::Vector3d onGround(const World& world, const Eigen::Vector2d& p) {
  return {p.x(), p.y(), world.groundHeight(p.x(), p.y())};
}

Solids personAt(const World& world, const Events::Person& person, double time) {
  const Eigen::Vector2d way = person.to - person.from;
  const double walked = std::min(way.norm(), person.speed * (time - person.begin));
  const Eigen::Vector2d place =
      way.norm() > 0 ? Eigen::Vector2d(person.from + way.normalized() * walked) : person.from;
  const double stride = walked < way.norm() ? walked / 0.7 : 0;
  return synthetic_world::person(onGround(world, place), std::atan2(way.y(), way.x()),
                                 {188, 62, 52}, stride);
}

}  // namespace

Solids Events::at(const World& world, double time) const {
  Solids solids;
  const auto add = [&solids](const Solids& more) {
    solids.insert(solids.end(), more.begin(), more.end());
  };
  for (const Person& person : persons)
    if (time >= person.begin && time < person.end) add(personAt(world, person, time));
  for (const Roadblock& block : roadblocks)
    if (time >= block.begin)
      add(synthetic_world::roadblock(onGround(world, block.at), block.yaw, block.length));
  return solids;
}

bool Events::sensorsWork(double time) const {
  return std::none_of(dropouts.begin(), dropouts.end(),
                      [time](const Span& s) { return time >= s.begin && time < s.end; });
}

Events::Person parsePerson(const std::string& text) {
  const auto n = parseNumbers(text, 5, 6, "BEGIN,X,Y,X2,Y2 or BEGIN,X,Y,X2,Y2,END");
  Events::Person person;
  person.begin = n[0], person.from = {n[1], n[2]}, person.to = {n[3], n[4]};
  if (n.size() > 5) person.end = n[5];
  return person;
}

Events::Roadblock parseRoadblock(const std::string& text) {
  const auto n = parseNumbers(text, 5, 5, "BEGIN,X,Y,DEG,LENGTH");
  return {n[0], {n[1], n[2]}, n[3] * M_PI / 180, n[4]};
}

Events::Span parseSpan(const std::string& text) {
  const auto n = parseNumbers(text, 2, 2, "BEGIN,END");
  return {n[0], n[1]};
}

using semantic_types::LabeledCloud;
using synthetic_world::CameraFrame;
using synthetic_world::CameraOptions;

namespace {

Eigen::Isometry3d T_robot_camera(double pitchDegrees) {
  return Eigen::Translation3d(0.25, 0, 1.2) *
         Eigen::AngleAxisd(pitchDegrees * M_PI / 180, Eigen::Vector3d::UnitY());
}

Eigen::Isometry3d T_robot_lidar() { return Eigen::Isometry3d(Eigen::Translation3d(0.1, 0, 1.4)); }

constexpr double kRounded = 1 - 1e-6;  // a point at some range may be a little nearer

/** \param emptyAt depth of pixels without a return; 0: these are left out */
LabeledCloud cloudOf(const CameraFrame& frame, const CameraOptions& options, double emptyAt) {
  LabeledCloud cloud;
  for (int row = 0; row < frame.depth.height; ++row)
    for (int column = 0; column < frame.depth.width; ++column) {
      const float seen = frame.depth.at(row, column);
      const double depth = seen > 0 ? seen : emptyAt;
      if (depth <= 0) continue;
      cloud.points.push_back((depth * options.ray(row, column)).cast<float>());
      cloud.classes.push_back(frame.labels.at(row, column));
    }
  return cloud;
}

}  // namespace

std::vector<Observation> SimulatedSensors::sense(const World& world,
                                                 const Eigen::Isometry3d& T_world_robot) {
  ++m_frame;
  std::vector<Observation> seen;
  if (m_config.hasCamera) seen.push_back(camera(world, T_world_robot));
  if (m_config.hasLidar) seen.push_back(lidar(world, T_world_robot));
  return seen;
}

Observation SimulatedSensors::camera(const World& world, const Eigen::Isometry3d& T_world_robot) {
  Observation seen;
  seen.T_robot_sensor = T_robot_camera(m_config.cameraPitch);
  CameraOptions options = m_config.camera;
  options.color = m_keepOriginals;
  const CameraFrame frame =
      renderCamera(world, T_world_robot * seen.T_robot_sensor, options, {m_config.seed, m_frame});
  seen.cloud = cloudOf(frame, options, m_config.emptyCarves ? options.maxRange : 0);
  if (m_config.emptyCarves) seen.emptyFrom = kRounded * options.maxRange;
  if (m_keepOriginals)
    seen.original = synthetic_rawlog::rangeScan(frame, options, seen.T_robot_sensor);
  return seen;
}

Observation SimulatedSensors::lidar(const World& world, const Eigen::Isometry3d& T_world_robot) {
  Observation seen;
  seen.T_robot_sensor = T_robot_lidar();
  synthetic_world::LidarOptions options = m_config.lidar;
  options.keepEmpty = m_config.emptyCarves;
  seen.cloud =
      scanLidar(world, T_world_robot * seen.T_robot_sensor, options, {m_config.seed, m_frame});
  if (m_config.emptyCarves) seen.emptyFrom = kRounded * options.maxRange;
  if (!m_keepOriginals) return seen;
  const auto original = synthetic_rawlog::labeledCloud(seen.cloud, seen.T_robot_sensor);
  original->emptyFrom = static_cast<float>(seen.emptyFrom);
  seen.original = original;
  return seen;
}

using measuring::Stopwatch;
using namespace semantic_driving;
using namespace semantic_planning;
using mrpt::math::TPose2D;
using semantic_octree::StoredMap;

namespace {

constexpr double kEpoch = 1704067200;  // 2024-01-01, UTC
constexpr double kSameTime = 1e-6;     // s

std::unique_ptr<StoredMap> prepared(std::unique_ptr<StoredMap> map, const DriveConfig& config) {
  if (!map)
    map = std::make_unique<StoredMap>(semantic_octree::SemanticOcTree(
        config.voxelSize, synthetic_world::classTable(), config.filter));
  if (!config.halfLives.empty())
    map->tree().setHalfLives(semantic_types::loadClassTable(config.halfLives));
  return map;
}

semantic_navigation::NavigatorOptions withLogs(const DriveConfig& config,
                                               const std::filesystem::path& navlogs) {
  semantic_navigation::NavigatorOptions options = config;
  options.logFolder = navlogs;
  return options;
}

/** On the plane z = 0. */
Eigen::Isometry3d isometry(const TPose2D& pose) {
  return Eigen::Translation3d(pose.x, pose.y, 0) *
         Eigen::AngleAxisd(pose.phi, Eigen::Vector3d::UnitZ());
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
                     const TPose2D& goal, Events events, std::unique_ptr<StoredMap> map,
                     std::filesystem::path navlogs)
    : m_config(config),
      m_world(world),
      m_events(std::move(events)),
      m_start(start),
      m_goal(goal),
      m_sensors(config.sensors, false),
      m_map(prepared(std::move(map), config)),
      m_mapper(m_map->tree(), config.mapping()),
      m_navigator(m_mapper, order, withLogs(config, navlogs)),
      m_robot(start, m_navigator.controller().tracker().options()),
      m_odometry(start, config.pose, config.sensors.seed),
      m_footprint(trueFootprint(config.planner.vehicle)) {
  m_navigator.onStage([this](const auto& stage, double ms) { note(stage, ms); });
  begin();
  updateRobot();
  setClock(0);
}

void DriveLoop::begin() {
  const auto classes = synthetic_world::classTable().size() + 1;
  m_record = {};
  m_record.drivenPerClass.resize(classes);
  m_record.plannedPerClass.resize(classes);
  m_record.exactPose = m_config.pose.isExact();
  m_began = m_time;
  m_navigator.setGoal(m_goal);
}

void DriveLoop::goOn(const TPose2D& goal) {
  m_start = m_robot.state().pose;
  m_goal = goal;
  m_explores = false;
  begin();
}

Eigen::Isometry3d DriveLoop::T_world_robot() const {
  const TPose2D& p = m_robot.state().pose;
  return m_world.poseOnGround(p.x, p.y, p.phi);
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
      sense();
    }
    const DriveCommand command = m_navigator.step(m_time);
    addRow();
    move(command);
    for (DriveObserver* o : m_observers) o->onDriven(*this);
    m_time += m_config.controlPeriod;
  }
  m_navigator.finish();
  m_record.replans = guide().replans();
  m_record.refusal = guide().refusal();
  for (DriveObserver* o : m_observers) o->onFinished(*this);
  return m_record;
}

void DriveLoop::sense() {
  if (!m_events.sensorsWork(m_time)) return m_navigator.see({}, m_time);
  Stopwatch watch(measuring::TimeOf::Thread);
  const std::vector<Observation> seen = m_sensors.sense(m_world, T_world_robot());
  note("simulate", watch.lap());
  m_navigator.see({seen.begin(), seen.end()}, m_time);
  for (DriveObserver* o : m_observers) o->onSensed(*this, seen);
}

void DriveLoop::note(const std::string& stage, double milliseconds) {
  auto& times = m_record.times;
  times[stage].push_back(milliseconds);
  if (stage == "update")
    m_record.leaves.push_back(static_cast<double>(m_navigator.numCompressedLeaves()));
  if (stage == "replan" && m_navigator.mappedAt() >= m_lookedAt && !times["insert"].empty())
    times["insert+update+replan"].push_back((m_config.focus.isOn() ? times["focus"].back() : 0) +
                                            times["insert"].back() + times["update"].back() +
                                            milliseconds);
}

void DriveLoop::move(const DriveCommand& command) {
  const TPose2D before = m_robot.state().pose;
  m_robot.drive(command, m_config.controlPeriod);
  m_odometry.move(m_robot.state().pose - before);
  updateRobot();
}

/** Height, roll and pitch are known. */
void DriveLoop::updateRobot() {
  semantic_navigation::RobotState robot{m_robot.state(), T_world_robot()};
  if (!m_record.exactPose) {
    robot.drive.pose = m_odometry.pose();
    robot.T_odometry_robot =
        isometry(m_odometry.pose()) * (isometry(m_robot.state().pose).inverse() * T_world_robot());
  }
  m_navigator.update(robot);
}

void DriveLoop::addRow() {
  DriveRow row;
  row.time = m_time;
  row.pose = m_robot.state().pose;
  row.believed = state().pose;
  row.odometry = m_record.exactPose ? row.pose : m_odometry.pose();
  row.z = groundZ();
  row.speed = state().speed;
  row.turn = state().turn;
  row.classId = m_world.groundClass(row.pose.x, row.pose.y);
  row.clearance = m_world.clearance(m_footprint, row.pose.x, row.pose.y, row.pose.phi);
  row.target = guide().target();
  row.isReactive = controller().isReactive();
  const PathTracker& tracker = controller().tracker();
  if (!tracker.path().empty()) row.offset = tracker.offset();
  std::optional<semantic_types::ClassId> planned;
  if (!tracker.path().empty()) {
    const PathPoint p = tracker.path().at(tracker.progress());
    row.bend = p.curvature;
    planned = m_world.groundClass(p.x, p.y);
  }
  m_record.add(row, planned, std::abs(row.speed) * m_config.controlPeriod);
}

bool DriveLoop::end(DriveEnd end, const std::string& reason) {
  m_record.end = end;
  m_record.reason = reason;
  return true;
}

bool DriveLoop::endEarly(DriveEnd how, const std::string& why) {
  m_navigator.endExploring(why);
  const std::string reason = m_navigator.reason();
  return end(how, reason.empty() ? why : reason);
}

bool DriveLoop::endAtGoal() {
  const TPose2D &p = m_robot.state().pose, &goal = guide().goal();
  const double off = std::hypot(p.x - goal.x, p.y - goal.y);
  if (!m_record.exactPose && off >= m_config.guide.atGoal)
    return end(DriveEnd::Astray,
               mrpt::format("it believes to have arrived, but is %.2f m off", off));
  return end(guide().refusal() ? DriveEnd::Nearest : DriveEnd::Arrived, m_navigator.reason());
}

bool DriveLoop::isOver() {
  using Status = semantic_navigation::Navigator::Status;
  const Status status = m_navigator.status();
  if (status == Status::Arrived || status == Status::Nearest) return endAtGoal();
  if (status == Status::Unreachable) return end(DriveEnd::Unreachable, m_navigator.reason());
  if (status == Status::Explored) return end(DriveEnd::Explored, m_navigator.reason());
  if (m_stop && m_stop()) return endEarly(DriveEnd::Stopped, "it was stopped on the way");
  return m_time - m_began >= m_config.timeLimit &&
         endEarly(DriveEnd::TimeLimit, "the time is over");
}

}  // namespace simulated_drive
