#include <semantic_navigation/Navigator.h>

#include <semantic_abstraction/Abstraction.h>
#include <semantic_driving/ObstacleSensing.h>
#include <semantic_planning/planner/OrderFile.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

namespace semantic_navigation {

using namespace semantic_driving;
using mrpt::math::TPose2D;
using semantic_octree::Abstraction;
using semantic_planning::SemanticPlanner;
using semantic_planning::StageTimes;
using semantic_slam::Mapper;
using semantic_slam::SensorScan;

namespace {

/** Milliseconds of the processor that a thread takes, stage by stage. */
class CpuClock {
 public:
  explicit CpuClock(clockid_t of = CLOCK_THREAD_CPUTIME_ID) : m_of(of), m_begin(now()) {}

  /** Since it began, or since the last lap. */
  double lap() {
    const double end = now(), passed = end - m_begin;
    m_begin = end;
    return passed;
  }

 private:
  double now() const {
    timespec t{};
    clock_gettime(m_of, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
  }

  const clockid_t m_of;
  double m_begin;
};

constexpr double kSameTime = 1e-6;  // s
constexpr double kNever = -1e9;     // s
constexpr double kRoom = 4;         // m: how far it may step aside

NavigatorOptions completed(NavigatorOptions options, double voxelSize) {
  options.setFor(voxelSize);
  return options;
}

SemanticPlanner plannerOn(semantic_octree::SemanticOcTree& map,
                          const colored_graph::ClassOrder& order, const NavigatorOptions& options) {
  setAbstraction(map, semantic_planning::abstractionFor(order));
  return SemanticPlanner(map, order, options.planner);
}

/** What a robot stands on where it begins: ground below its footprint and around it, as far as the
 * planner wants to know. Sensors do not see that near: it has the class of what they see on both
 * sides (GroundOptions::unknownGap), if that is one, otherwise whatever class.
 * \param height of the robot's frame above the ground, m
 * \return points in the robot's frame, in the voxels that hold the ground */
semantic_types::LabeledCloud groundBelow(const semantic_planning::SemanticPlanner& planner,
                                         const Eigen::Isometry3d& T_map_robot, double height) {
  constexpr double kBelow = 1e-3;  // m
  const semantic_planning::VehicleOptions& vehicle = planner.options().vehicle;
  const semantic_planning::Ground& ground = planner.ground();
  const double room = vehicle.clearance + ground.voxelSize(), step = ground.voxelSize() / 2;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : vehicle.footprint) box.extend(corner);
  semantic_types::LabeledCloud cloud;
  for (double x = box.min().x() - room; x < box.max().x() + room; x += step)
    for (double y = box.min().y() - room; y < box.max().y() + room; y += step) {
      const Eigen::Vector3d below(x, y, -height - kBelow), p = T_map_robot * below;
      const auto* known =
          ground.near(ground.columnAt(p.x(), p.y()), ground.keyOf(p.z()), ground.step());
      cloud.points.push_back(below.cast<float>());
      cloud.classes.push_back(known ? known->classId : semantic_types::kNoClass);
    }
  return cloud;
}

/** Who stands is in the way, though the map does not have him yet. */
void addStanding(const DynamicObstacles& movers, const TPose2D& robot, ObstaclePoints& obstacles) {
  constexpr int kPoints = 8;
  for (const DynamicObstacle& mover : movers)
    for (int i = 0; mover.stands() && i < kPoints; ++i) {
      const double to = i * 2 * M_PI / kPoints;
      const auto p = robot.inverseComposePoint({mover.place.x() + mover.size * std::cos(to),
                                                mover.place.y() + mover.size * std::sin(to)});
      obstacles.emplace_back(p.x, p.y);
    }
}

/** The map has something in the space that the robot takes, above what its wheels climb. */
bool isAnythingWithin(const semantic_octree::SemanticOcTree& map,
                      const semantic_planning::VehicleOptions& vehicle,
                      const Eigen::Isometry3d& T_map_robot) {
  const double step = map.getResolution();
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : vehicle.footprint) box.extend(corner);
  for (double x = box.min().x(); x < box.max().x(); x += step)
    for (double y = box.min().y(); y < box.max().y(); y += step)
      for (double z = vehicle.stepHeight + step; z < vehicle.height; z += step) {
        const Eigen::Vector3d p = T_map_robot * Eigen::Vector3d(x, y, z);
        if (vehicle.footprint.distance({x, y}) == 0 &&
            map.query(p.x(), p.y(), p.z()).status == semantic_octree::CellState::Status::Occupied)
          return true;
      }
  return false;
}

}  // namespace

void NavigatorOptions::setFor(double voxelSize) {
  constexpr double kBeyond = 1;  // m
  drive.setFor(planner.vehicle.turningRadius, voxelSize);
  movers.radius = std::max(movers.radius, 2 * obstacleRadius());
  if (focus.around == 0) focus.around = obstacleRadius() + kBeyond;
}

double NavigatorOptions::obstacleRadius() const {
  double reach = 0;  // of the vehicle
  for (const Eigen::Vector2d& corner : planner.vehicle.footprint)
    reach = std::max(reach, corner.norm());
  return 1.5 * drive.lookAhead() + reach;
}

Navigator::Navigator(Mapper& mapper, const colored_graph::ClassOrder& order,
                     const NavigatorOptions& options)
    : m_options(completed(options, mapper.map().getResolution())),
      m_mapper(mapper),
      m_planner(plannerOn(mapper.map(), order, m_options)),
      m_leaves(mapper.map()),
      m_controller(m_options.drive,
                   {m_options.reactive, m_options.planner.vehicle.footprint, m_options.logFolder}),
      m_movers(m_options.movers, mapper.map().classes()),
      m_mappedAt(kNever) {
  m_mapper.setMovers(m_movers.isMover());
  m_controller.setClassSpeeds(m_options.drive.classSpeeds(order));
}

void Navigator::setGoal(const TPose2D& goal) {
  m_guide.emplace(m_options.guide, m_planner, goal);
  m_controller.setPath({});
  m_restsFirst = m_guidesNext = true;
  m_views.reset();
  m_conclusion.clear();
}

void Navigator::explore(const std::optional<tree_abstraction::AbstractionWeights>& weights,
                        const ExploreOptions& options) {
  auto views = weights ? relevantViews(m_planner, waitedFor().map(), *weights, options)
                       : nearestFrontier(m_planner, options);
  m_options.explore = options;
  setGoal(m_state.pose);
  m_views = std::move(views);
  m_view.reset();
  m_driven = 0;
}

double Navigator::leftToSee(double x, double y) {
  waitedFor();
  return m_views ? m_views->left(m_planner.ground().columnAt(x, y)) : 0;
}

void Navigator::update(const RobotState& robot) {
  const TPose2D before = m_robot.drive.pose;
  m_robot = robot;
  m_driven += std::hypot(robot.drive.pose.x - before.x, robot.drive.pose.y - before.y);
  correctState();
}

/** Without corrections it is where odometry has it, to the last bit. */
void Navigator::correctState() {
  m_state = m_robot.drive;
  m_z = m_height.onGround(m_robot.T_odometry_robot).translation().z();
  if (!m_mapper.slam()) return;
  const TPose2D& p = m_robot.drive.pose;
  const Eigen::Isometry3d T = m_mapper.T_map_odometry() * Eigen::Translation3d(p.x, p.y, m_z) *
                              Eigen::AngleAxisd(p.phi, Eigen::Vector3d::UnitZ());
  m_state.pose = {T.translation().x(), T.translation().y(), std::atan2(T(1, 0), T(0, 0))};
  m_z = T.translation().z();
}

/** A stamp that is far from the last step's is none of this clock, and counts as that step's. */
double Navigator::withoutLeaps(double seconds) const {
  constexpr double kLeap = 60;
  const double expected = seconds - m_leapt;
  const bool leaps = m_steppedAt && std::abs(expected - *m_steppedAt) > kLeap;
  return leaps ? *m_steppedAt : expected;
}

void Navigator::see(const std::vector<SensorScan>& seen, double stamp) {
  const double seconds = withoutLeaps(stamp);
  m_guidesNext = true;
  if (seen.empty()) return;
  CpuClock clock;
  const Eigen::Isometry3d T_map_robot = m_mapper.T_map_odometry() * m_robot.T_odometry_robot;
  for (const SensorScan& scan : seen) m_movers.see(scan.cloud, T_map_robot * scan.T_robot_sensor);
  m_movers.update(seconds);
  note("movers", clock.lap());
  if (!isInserting()) insert(seen, seconds);
}

/** Begins to. Where the robot is when it sees that is told now, the map may be filled later. */
void Navigator::insert(const std::vector<SensorScan>& seen, double seconds) {
  m_mapper.age(seconds);
  focus();
  m_insertingFrom = seconds;
  const Mapper::Place at = locate(seen, seconds);
  std::vector<SensorScan> straight;
  for (const SensorScan& scan : seen) straight.push_back(deskewed(scan, at.velocity));
  auto fillMap = [this, lasting = withoutPassing(std::move(straight)), left = m_movers.takeLeft(),
                  at, seconds] { return fill(lasting, at, left, seconds); };
  if (m_options.mappingLatency == 0) {
    m_inserting = std::async(std::launch::deferred, std::move(fillMap));
    return finish();
  }
  const double drivenMeanwhile = m_options.drive.maxSpeed * m_options.mappingLatency;
  m_before = knownObstacles(m_options.obstacleRadius() + drivenMeanwhile, false);
  m_roomBefore = knownObstacles(kRoom + drivenMeanwhile, true);
  m_beforeAt = m_state.pose;
  m_inserting = std::async(std::launch::async, std::move(fillMap));
}

Mapper::Place Navigator::locate(const std::vector<SensorScan>& seen, double seconds) {
  CpuClock clock;
  const Mapper::Place at = m_mapper.locate(seen, m_robot.T_odometry_robot, seconds);
  if (!at.added) return at;
  correctState();
  note("localize", clock.lap());
  return at;
}

std::vector<SensorScan> Navigator::withoutPassing(std::vector<SensorScan> seen) const {
  const Eigen::Isometry3d T_map_robot = m_mapper.T_map_odometry() * m_robot.T_odometry_robot;
  for (SensorScan& scan : seen)
    scan.cloud = m_movers.withoutPassing(scan.cloud, T_map_robot * scan.T_robot_sensor);
  return seen;
}

/** Nothing is where the robot is, nor where somebody was who walked away. Sensors that do not see
 * that near or low leave it in the map. */
void Navigator::carve(const Mapper::Place& at, const std::vector<Eigen::Vector2d>& left) {
  constexpr int kSure = 10;      // beams until it is free, whatever was seen before
  constexpr double kBody = 0.4;  // m
  const semantic_planning::VehicleOptions& vehicle = m_planner.options().vehicle;
  const Eigen::Isometry3d T_map_ground = m_fillsHeight.onGround(at.T_map_robot);
  const auto column = [&](const Eigen::Vector3d& base, double radius) {
    for (double z = vehicle.stepHeight + radius; z < vehicle.height + radius; z += radius)
      for (int i = 0; i < kSure; ++i)
        m_mapper.insertFree(base + z * Eigen::Vector3d::UnitZ(), radius, at);
  };
  for (const Eigen::Vector2d& p : left)
    column(at.T_map_robot.inverse() * Eigen::Vector3d(p.x(), p.y(), T_map_ground.translation().z()),
           kBody);
  if (!isAnythingWithin(m_mapper.map(), vehicle, T_map_ground)) return;
  for (const semantic_planning::Disc& d :
       vehicle.footprint.coveringDiscs(m_mapper.map().getResolution()))
    column({d.x, d.y, -m_fillsHeight.meters().value_or(0)}, d.radius);
}

StageTimes Navigator::fill(const std::vector<SensorScan>& seen, const Mapper::Place& at,
                           const std::vector<Eigen::Vector2d>& left, double seconds) {
  CpuClock clock;
  m_mapper.insert(seen, at, seconds);
  carve(at, left);
  StageTimes times{{"insert", clock.lap()}};
  m_planner.update();
  m_fillsHeight.look(m_planner.ground(), m_planner.options().vehicle, at.T_map_robot);
  if (!m_stands && m_fillsHeight.meters()) {
    m_stands = true;
    m_mapper.insertBelow(groundBelow(m_planner, at.T_map_robot, *m_fillsHeight.meters()), at);
    m_planner.update();
  }
  times.emplace_back("update", clock.lap());
  return times;
}

void Navigator::finish() {
  if (!isInserting()) return;
  const StageTimes times = m_inserting.get();
  m_mappedAt = m_insertingFrom;
  m_height = m_fillsHeight;
  correctState();  // by what is known of it
  for (const auto& [stage, milliseconds] : times) note(stage, milliseconds);
}

Mapper& Navigator::waitedFor() const {
  if (isInserting()) m_inserting.wait();
  return m_mapper;
}

void Navigator::focus() {
  if (!m_options.focus.isOn()) return;
  CpuClock clock;
  const PathTracker& tracker = m_controller.tracker();
  const Eigen::Vector3d robot(m_state.pose.x, m_state.pose.y, m_z);
  Abstraction(m_mapper.map())
      .setRegions(regionsAhead(tracker.path(), tracker.progress(), robot, m_options.focus));
  note("focus", clock.lap());
}

std::size_t Navigator::numCompressedLeaves() {
  waitedFor();
  return m_leaves.skipLeaves();
}

DriveCommand Navigator::step(double clock) {
  const double seconds = std::max(m_steppedAt.value_or(kNever), withoutLeaps(clock));
  m_steppedAt = seconds;
  m_leapt = clock - seconds;
  m_insertingFrom = std::min(m_insertingFrom, seconds);  // stamps of before the first step may lie
  m_mappedAt = std::min(m_mappedAt, seconds);
  if (isInserting() && seconds - m_insertingFrom >= m_options.mappingLatency - kSameTime) finish();
  if (m_guidesNext && mayGuide()) guide(seconds);
  CpuClock time;
  const DynamicObstacles movers = m_movers.at(seconds);
  ObstaclePoints around = obstacles(m_options.obstacleRadius(), false);
  addStanding(movers, m_state.pose, around);
  note("obstacles", time.lap());
  ObstaclePoints room;
  if (!movers.empty()) room = obstacles(kRoom, true);
  const DriveCommand command = m_controller.step(m_state, around, seconds - m_mappedAt, seconds,
                                                 movers, movers.empty() ? nullptr : &room);
  note("react", time.lap());
  return command;
}

bool Navigator::mayGuide() const {
  const bool rests = !m_restsFirst || std::abs(m_state.speed) < DriveOptions::kAtRest;
  return m_guide && !isInserting() && rests;
}

void Navigator::guide(double seconds) {
  CpuClock clock(CLOCK_PROCESS_CPUTIME_ID);  // searches have a thread; others rarely do
  m_guidesNext = m_restsFirst = false;
  if (m_views && m_conclusion.empty() && isTimeToChoose()) chooseView();
  if (m_conclusion.empty()) m_guide->update(m_state, m_z, m_controller, seconds);
  m_guidesNext = m_guide->isSearching();
  note("replan", clock.lap());
}

/** At the view, where it cannot be reached, on a long way there, and when the budget is driven. */
bool Navigator::isTimeToChoose() const {
  constexpr double kBetween = 5;  // m
  return !m_view || m_guide->arrived(m_state, m_controller) || m_guide->gaveUp() ||
         m_driven - m_chosenAt >= kBetween || m_driven >= m_options.explore.budget;
}

void Navigator::chooseView() {
  if (m_view && (m_guide->arrived(m_state, m_controller) || m_guide->gaveUp()))
    m_views->done(*m_view);
  m_chosenAt = m_driven;
  const bool isBudgetDriven = m_driven >= m_options.explore.budget;
  if (isBudgetDriven) return conclude("the budget is driven; ");
  const auto next = m_views->next(m_state.pose, m_z);
  if (!next) return conclude("");
  if (m_view && m_view->pose == next->pose && !m_guide->gaveUp()) return;
  m_view = next;
  m_guide.emplace(m_options.guide, m_planner, next->pose);
}

void Navigator::conclude(const std::string& why) {
  m_conclusion = why + m_views->conclusion();
  m_controller.setPath({});
  if (m_guide) m_guide->stopSearching();
  m_guidesNext = false;
}

void Navigator::endExploring(const std::string& why) {
  waitedFor();
  if (m_views && m_conclusion.empty()) conclude(why + "; ");
}

/** What of the map is in the way, in the robot's frame. */
ObstaclePoints Navigator::knownObstacles(double radius, bool unknown) const {
  ObstacleOptions options = m_guide && !unknown ? m_guide->obstacles() : ObstacleOptions();
  options.radius = radius;
  options.unknown = unknown;
  return senseObstacles(m_planner, m_state.pose, m_z, options);
}

/** While a scan is inserted, as it was known before. */
ObstaclePoints Navigator::obstacles(double radius, bool unknown) const {
  return isInserting()
             ? seenFrom(unknown ? m_roomBefore : m_before, m_beforeAt, m_state.pose, radius)
             : knownObstacles(radius, unknown);
}

Navigator::Status Navigator::status() const {
  if (!m_guide) return Status::Idle;
  if (m_views) {
    const bool isOver = !m_conclusion.empty() && std::abs(m_state.speed) < DriveOptions::kAtRest;
    return isOver ? Status::Explored : Status::Driving;
  }
  if (m_guide->arrived(m_state, m_controller))
    return m_guide->refusal() ? Status::Nearest : Status::Arrived;
  const bool stands = std::abs(m_state.speed) < DriveOptions::kAtRest;
  return m_guide->gaveUp() && stands ? Status::Unreachable : Status::Driving;
}

std::string Navigator::reason() const {
  if (!m_conclusion.empty()) return m_conclusion;
  const Status now = status();
  if (now == Status::Nearest) return m_guide->refusal()->reason;
  return now == Status::Unreachable ? m_guide->reason() : std::string();
}

void Navigator::note(const std::string& stage, double milliseconds) const {
  if (m_onStage) m_onStage(stage, milliseconds);
}

}  // namespace semantic_navigation
