#include "Trial.h"

#include <utility>

#include "measuring/Stopwatch.h"
#include "simulated_drive/DriveFiles.h"

namespace drive_study {

using namespace simulated_drive;

std::string Trial::fault() const {
  constexpr double kMore = 1.05, kVoxel = 0.2;  // m: lengths are no better known
  if (collisions > 0) return "collision";
  if (task.hasPath && end != DriveEnd::Arrived) return "did not arrive";
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
  const DriveRecord& record = loop.run();
  world.setMovables({});
  Trial trial;
  trial.task = task;
  trial.end = record.end;
  trial.reason = record.reason;
  trial.explored = std::as_const(loop).guide().explored();
  trial.seconds = record.duration();
  trial.length = record.length;
  trial.badDriven = badLength(record.drivenPerClass, order);
  trial.badFollowed = badLength(record.plannedPerClass, order);
  trial.badBest = badLength(task.lengthPerClass, order);
  trial.leastClearance = record.leastClearance;
  trial.collisions = record.collisions;
  trial.replans = record.replans;
  trial.processorSeconds = watch.milliseconds() / 1e3;
  return trial;
}

}  // namespace drive_study
