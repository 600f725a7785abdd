#include "Tasks.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "TrueMap.h"
#include "simulated_drive/DriveLoop.h"

namespace drive_study {

using colored_graph::ClassOrder;
using mrpt::math::TPose2D;
using namespace semantic_planning;
using synthetic_world::World;

namespace {

constexpr std::array<std::size_t, 2> kVertices = {2000, 8000};  // of the oracle's graphs

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

/** \param accepts whether a pose serves as the goal \param goal what it is, in words */
template <class Accepts>
Task TaskDraw::draw(Accepts accepts, const char* goal) {
  constexpr int kMostTries = 100000;
  for (int i = 0; i < kMostTries; ++i) {
    Task task;
    task.start = anyPose();
    task.goal = anyPose();
    const double distance = std::hypot(task.goal.x - task.start.x, task.goal.y - task.start.y);
    if (distance < m_options.nearest || distance > m_options.farthest) continue;
    if (isFree(task.start) && accepts(task.goal)) return task;
  }
  throw std::runtime_error("no start on free ground and goal " + std::string(goal) + ", " +
                           std::to_string(m_options.nearest) + " to " +
                           std::to_string(m_options.farthest) + " m apart, in " +
                           std::to_string(kMostTries) + " draws");
}

Task TaskDraw::next() {
  return draw([this](const TPose2D& pose) { return isFree(pose); }, "on free ground");
}

Task TaskDraw::nextUnfit() {
  Task task = draw([this](const TPose2D& pose) { return isUnfit(pose); },
                   "where the robot does not fit, beside free ground");
  task.unfit = true;
  task.reason = "the robot does not fit at the goal";
  return task;
}

Task TaskDraw::nextEnclosed() {
  Task task = next();
  task.enclosed = true;
  task.reason = "barriers all around the goal";
  return task;
}

TPose2D TaskDraw::anyPose() {
  constexpr double kRim = 5;  // m
  const double far = m_world.halfExtent() - kRim;
  const double x = m_random.uniform(-far, far), y = m_random.uniform(-far, far);
  return {x, y, m_random.uniform(-M_PI, M_PI)};
}

bool TaskDraw::isAllowed(const TPose2D& pose, double clearance) const {
  const auto isAllowedAt = [this](const mrpt::math::TPoint2D& p) {
    return m_order.rank(m_world.groundClass(p.x, p.y)) != colored_graph::kForbidden;
  };
  for (const Eigen::Vector2d& corner : m_footprint.outline) {
    const Eigen::Vector2d far = corner + clearance * corner.cwiseSign();
    if (!isAllowedAt(pose.composePoint({far.x(), far.y()}))) return false;
  }
  return isAllowedAt({pose.x, pose.y});
}

bool TaskDraw::isFree(const TPose2D& pose) const {
  return isAllowed(pose, m_options.clearance) &&
         m_world.clearance(m_footprint, pose.x, pose.y, pose.phi) > m_options.clearance;
}

bool TaskDraw::isUnfit(const TPose2D& pose) {
  constexpr int kTries = 20;
  constexpr double kBeside = 2;  // m
  if (isAllowed(pose, 0) && m_world.isFree(m_footprint, pose.x, pose.y, pose.phi)) return false;
  for (int i = 0; i < kTries; ++i)
    if (isFree({pose.x + m_random.uniform(-kBeside, kBeside),
                pose.y + m_random.uniform(-kBeside, kBeside), pose.phi}))
      return true;
  return false;
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
         (task.unfit || planner.check(task.goal) == PlanStatus::Found);
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

}  // namespace drive_study
