#include "Trial.h"

#include <algorithm>
#include <utility>

#include "measuring/Quantile.h"
#include "measuring/Stopwatch.h"

namespace drive_study {

using namespace simulated_drive;

namespace {

/** Notes when a sensor first saw the goal's place, near enough for the map. */
class GoalWatch : public DriveObserver {
 public:
  void onSensed(const DriveLoop& loop, const std::vector<Observation>& seen) override {
    for (const Observation& o : seen)
      if (m_seenAt < 0 && shows(o, loop)) m_seenAt = loop.time();
  }
  double seenAt() const { return m_seenAt; }

 private:
  static bool shows(const Observation& o, const DriveLoop& loop) {
    constexpr double kNear = 0.3;  // m
    const Eigen::Isometry3d T_world_sensor = loop.T_world_robot() * o.T_robot_sensor;
    const Eigen::Vector2d goal(loop.goal().x, loop.goal().y);
    const double far = loop.config().insertion.maxRange;
    return std::any_of(o.cloud.points.begin(), o.cloud.points.end(),
                       [&](const Eigen::Vector3f& point) {
                         const Eigen::Vector3d p = T_world_sensor * point.cast<double>();
                         return point.norm() <= far && (p.head<2>() - goal).norm() < kNear;
                       });
  }

  double m_seenAt = -1;
};

/** Milliseconds from a scan to the path that follows from it. */
std::vector<double> cyclesOf(const DriveRecord& record) {
  std::vector<double> cycles;
  if (record.times.count("insert+update+replan")) cycles = record.times.at("insert+update+replan");
  if (const auto localize = record.times.find("localize"); localize != record.times.end())
    for (std::size_t i = 0; i < std::min(cycles.size(), localize->second.size()); ++i)
      cycles[i] += localize->second[i];
  return cycles;
}

}  // namespace

std::string Trial::fault() const {
  constexpr double kAtOnce = 15;                // s
  constexpr double kMore = 1.05, kVoxel = 0.2;  // m: lengths are no better known
  if (collisions > 0) return "collision";
  if (task.hasPath && end != DriveEnd::Arrived) return "did not arrive";
  if (task.unfit && end == DriveEnd::Arrived) return "arrived where it does not fit";
  if (task.unfit && seenAt >= 0 && refusedAt > seenAt + kAtOnce)
    return "said late that the goal does not fit";
  if (!task.hasPath && end == DriveEnd::TimeLimit) return "did not say that there is no path";
  if (badDriven > kMore * badFollowed + kVoxel) return "left its path for worse classes";
  return {};
}

Trial runTrial(const DriveConfig& config, synthetic_world::World& world,
               const colored_graph::ClassOrder& order, const Task& task) {
  const measuring::Stopwatch watch(measuring::TimeOf::Thread);
  Events events;
  if (task.enclosed) events.roadblocks = barriersAround({task.goal.x, task.goal.y}, kBarriersAt);
  DriveLoop loop(config, world, order, task.start, task.goal, events);
  GoalWatch watchGoal;
  loop.addObserver(watchGoal);
  const DriveRecord& record = loop.run();
  world.setMovables({});
  Trial trial;
  trial.task = task;
  trial.end = record.end;
  trial.reason = record.reason;
  trial.seenAt = watchGoal.seenAt();
  if (record.refusal) trial.refusedAt = record.refusal->seconds;
  trial.explored = std::as_const(loop).guide().explored();
  trial.seconds = record.duration();
  trial.length = record.length;
  trial.badDriven = badLength(record.drivenPerClass, order);
  trial.badFollowed = badLength(record.plannedPerClass, order);
  trial.badBest = badLength(task.lengthPerClass, order);
  trial.leastClearance = record.leastClearance;
  trial.collisions = record.collisions;
  trial.replans = record.replans;
  trial.smooth = smoothnessOf(record);
  trial.poseErrors = poseErrorsOf(record, &DriveRow::believed);
  trial.odometryErrors = poseErrorsOf(record, &DriveRow::odometry);
  if (const std::vector<double> cycles = cyclesOf(record); !cycles.empty()) {
    trial.cycle = measuring::quantile(cycles, 0.5);
    trial.slowCycle = measuring::quantile(cycles, 0.95);
  }
  if (!record.leaves.empty()) trial.leaves = measuring::quantile(record.leaves, 0.5);
  trial.processorSeconds = watch.milliseconds() / 1e3;
  return trial;
}

}  // namespace drive_study
