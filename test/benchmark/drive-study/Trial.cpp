#include "Trial.h"

#include <synthetic_world/Solids.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "measuring/Measuring.h"

namespace drive_study {

using colored_graph::ClassOrder;
using mrpt::math::TPose2D;
using namespace semantic_planning;
using semantic_types::LabeledCloud;
using synthetic_world::PointTruth;
using synthetic_world::World;

namespace {

constexpr std::array<std::size_t, 2> kVertices = {2000, 8000};  // of the oracle's graphs

/** The centers of the voxels that something fills, column by column. */
class TrueVoxels {
 public:
  TrueVoxels(const World& world, double voxelSize, double height)
      : m_world(world),
        m_voxelSize(voxelSize),
        m_layers(static_cast<int>(std::ceil(height / voxelSize)) + 1) {}

  LabeledCloud all() {
    const int half = static_cast<int>(m_world.halfExtent() / m_voxelSize);
    for (int y = -half; y < half; ++y)
      for (int x = -half; x < half; ++x) addColumn(center(x), center(y));
    return std::move(m_cloud);
  }

 private:
  double center(int i) const { return (i + 0.5) * m_voxelSize; }

  void add(double x, double y, double z, semantic_types::ClassId id) {
    m_cloud.points.push_back(Eigen::Vector3d(x, y, z).cast<float>());
    m_cloud.classes.push_back(id);
  }

  void addColumn(double x, double y) {
    const int ground = static_cast<int>(std::floor(m_world.groundHeight(x, y) / m_voxelSize));
    add(x, y, center(ground), m_world.groundClass(x, y));
    for (int z = ground + 1; z <= ground + m_layers; ++z) {
      const PointTruth truth = m_world.at({x, y, center(z)}, m_voxelSize / 2);
      if (isThing(truth)) add(x, y, center(z), truth.id);
    }
  }

  /** The ground is in its own voxel, and not in the one above that it nearly reaches. */
  static bool isThing(const PointTruth& truth) {
    return truth.state != PointTruth::State::Free &&
           (truth.state != PointTruth::State::Surface || truth.id > synthetic_world::kWater);
  }

  const World& m_world;
  double m_voxelSize;
  int m_layers;
  LabeledCloud m_cloud;
};

}  // namespace

void TaskOptions::describe(strict_files::OptionList& list) {
  list.add("nearest", nearest, "m", strict_files::above(0), "from start to goal, at least");
  list.add("farthest", farthest, "m", strict_files::above(0), "from start to goal, at most");
  list.add("clearance", clearance, "m", strict_files::atLeast(0),
           "around the footprint at start and goal");
  list.add("seed", seed, "", "another one makes other pairs");
}

void TaskOptions::validate() const {
  strict_files::checkOptions(*this, "TaskOptions");
  if (!(farthest > nearest))
    throw std::invalid_argument("TaskOptions: distances from " + std::to_string(nearest) + " to " +
                                std::to_string(farthest) + " m");
}

TaskDraw::TaskDraw(const World& world, const ClassOrder& order, const VehicleOptions& vehicle,
                   const TaskOptions& options)
    : m_world(world),
      m_order(order),
      m_footprint(simulated_drive::trueFootprint(vehicle)),
      m_options(options),
      m_random(options.seed) {
  m_options.validate();
}

Task TaskDraw::next() {
  constexpr int kMostTries = 100000;
  for (int i = 0; i < kMostTries; ++i) {
    Task task;
    task.start = anyPose();
    task.goal = anyPose();
    const double distance = std::hypot(task.goal.x - task.start.x, task.goal.y - task.start.y);
    if (distance < m_options.nearest || distance > m_options.farthest) continue;
    if (isFree(task.start) && isFree(task.goal)) return task;
  }
  throw std::runtime_error("no start on free ground and goal on free ground, " +
                           std::to_string(m_options.nearest) + " to " +
                           std::to_string(m_options.farthest) + " m apart, in " +
                           std::to_string(kMostTries) + " draws");
}

TPose2D TaskDraw::anyPose() {
  constexpr double kRim = 5;  // m
  const double far = m_world.halfExtent() - kRim;
  const double x = m_random.uniform(-far, far), y = m_random.uniform(-far, far);
  return {x, y, m_random.uniform(-M_PI, M_PI)};
}

bool TaskDraw::isFree(const TPose2D& pose) const {
  const auto isAllowedAt = [this](const mrpt::math::TPoint2D& p) {
    return m_order.rank(m_world.groundClass(p.x, p.y)) != colored_graph::kForbidden;
  };
  for (const Eigen::Vector2d& corner : m_footprint.outline) {
    const Eigen::Vector2d far = corner + m_options.clearance * corner.cwiseSign();
    if (!isAllowedAt(pose.composePoint({far.x(), far.y()}))) return false;
  }
  return isAllowedAt({pose.x, pose.y}) &&
         m_world.clearance(m_footprint, pose.x, pose.y, pose.phi) > m_options.clearance;
}

semantic_octree::SemanticOcTree trueMap(const World& world, double voxelSize, double height) {
  LabeledCloud cloud = TrueVoxels(world, voxelSize, height).all();
  semantic_octree::SemanticOcTree map(voxelSize, synthetic_world::classTable());
  semantic_octree::InsertionOptions options;
  options.carvingMargin = 1e6;  // nothing is carved: what is not filled stays unknown
  map.insert(cloud, Eigen::Isometry3d::Identity(), options);
  return map;
}

Oracle::Oracle(const World& world, const ClassOrder& order, const PlannerOptions& planner,
               double voxelSize)
    : m_world(world),
      m_order(order),
      m_options(planner),
      m_map(trueMap(world, voxelSize, planner.vehicle.height)) {
  m_options.roadmap.kind = GraphKind::HaltonDrivable;
}

SemanticPlanner& Oracle::plannerWith(std::size_t vertices) {
  const auto found = m_planners.find(vertices);
  if (found != m_planners.end()) return found->second;
  m_options.roadmap.vertices = vertices;
  return m_planners.emplace(vertices, SemanticPlanner(m_map, m_order, m_options)).first->second;
}

bool Oracle::accepts(const Task& task) {
  const SemanticPlanner& planner = plannerWith(kVertices.front());
  return planner.check(task.start) == PlanStatus::Found &&
         planner.check(task.goal) == PlanStatus::Found;
}

void Oracle::solve(Task& task) {
  for (const std::size_t vertices : kVertices) {
    const PlanResult plan = plannerWith(vertices).plan(task.start, task.goal);
    task.hasPath = plan.found();
    task.reason = plan.reason;
    task.length = plan.length;
    task.lengthPerClass.assign(synthetic_world::classTable().size() + 1, 0);
    for (std::size_t i = 1; i < plan.path.size(); ++i)
      task.lengthPerClass[m_world.groundClass(plan.path[i].x, plan.path[i].y)] +=
          plan.path[i].arcLength - plan.path[i - 1].arcLength;
    if (plan.status != PlanStatus::NotConnected) return;
  }
}

using namespace simulated_drive;

std::string Trial::fault() const {
  constexpr double kMore = 1.05, kVoxel = 0.2;  // m: lengths are no better known
  if (record.collisions > 0) return "collision";
  if (task.hasPath && record.end != DriveEnd::Arrived) return "did not arrive";
  if (!task.hasPath && record.end == DriveEnd::TimeLimit)
    return "did not say that there is no path";
  if (badDriven > kMore * badFollowed + kVoxel) return "left its path for worse classes";
  return {};
}

Trial runTrial(const DriveConfig& config, synthetic_world::World& world,
               const colored_graph::ClassOrder& order, const Task& task) {
  const measuring::Stopwatch watch(measuring::TimeOf::Thread);
  DriveLoop loop(config, world, order, task.start, task.goal, {});
  const DriveRecord& record = loop.run();
  Trial trial;
  trial.task = task;
  trial.record = record;
  trial.explored = std::as_const(loop).guide().explored();
  trial.badDriven = badLength(record.drivenPerClass, order);
  trial.badFollowed = badLength(record.plannedPerClass, order);
  trial.processorSeconds = watch.milliseconds() / 1e3;
  return trial;
}

nlohmann::json toJson(const Trial& trial, const ClassOrder& order) {
  const auto pose = [](const TPose2D& p) { return nlohmann::json{p.x, p.y, p.phi * 180 / M_PI}; };
  return {{"scene", trial.scene},
          {"number", trial.number},
          {"start", pose(trial.task.start)},
          {"goal", pose(trial.task.goal)},
          {"hasPath", trial.task.hasPath},
          {"whyNoPath", trial.task.reason},
          {"pathMeters", trial.task.length},
          {"pathMetersInWorseClasses", badLength(trial.task.lengthPerClass, order)},
          {"fault", trial.fault()},
          {"frontiers", trial.explored},
          {"processorSeconds", trial.processorSeconds},
          {"drive", toJson(trial.record, order)}};
}

}  // namespace drive_study
