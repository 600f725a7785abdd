#include "Trial.h"

#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "measuring/Quantile.h"
#include "measuring/Stopwatch.h"

namespace drive_study {

using namespace simulated_drive;
using strict_files::csvField;

namespace {

/** Milliseconds from a scan to the path that follows from it. */
std::vector<double> cyclesOf(const DriveRecord& record) {
  std::vector<double> cycles;
  if (record.times.count("insert+update+replan")) cycles = record.times.at("insert+update+replan");
  if (const auto localize = record.times.find("localize"); localize != record.times.end())
    for (std::size_t i = 0; i < std::min(cycles.size(), localize->second.size()); ++i)
      cycles[i] += localize->second[i];
  return cycles;
}

/** A number of each drive. */
struct Column {
  const char* name;
  double (*of)(const Trial&);
};

double degrees(double radians) { return radians * 180 / M_PI; }

const std::vector<Column>& columns() {
  using T = const Trial&;
  static const std::vector<Column> columns = {
      {"start_x", [](T t) { return t.task.start.x; }},
      {"start_y", [](T t) { return t.task.start.y; }},
      {"start_deg", [](T t) { return degrees(t.task.start.phi); }},
      {"goal_x", [](T t) { return t.task.goal.x; }},
      {"goal_y", [](T t) { return t.task.goal.y; }},
      {"goal_deg", [](T t) { return degrees(t.task.goal.phi); }},
      {"path_length", [](T t) { return t.task.length; }},
      {"path_worse", [](T t) { return t.badBest; }},
      {"seconds", [](T t) { return t.seconds; }},
      {"length", [](T t) { return t.length; }},
      {"worse", [](T t) { return t.badDriven; }},
      {"worse_planned", [](T t) { return t.badFollowed; }},
      {"collisions", [](T t) { return double(t.collisions); }},
      {"clearance", [](T t) { return t.leastClearance; }},
      {"replans", [](T t) { return double(t.replans); }},
      {"explored", [](T t) { return double(t.explored); }},
      {"jerk", [](T t) { return t.smooth.jerk; }},
      {"backwards", [](T t) { return t.smooth.backwards; }},
      {"longest_backwards", [](T t) { return t.smooth.longestBackwards; }},
      {"gear_changes", [](T t) { return double(t.smooth.gearChanges); }},
      {"turn_changes", [](T t) { return double(t.smooth.turnChanges); }},
      {"path_turn_changes", [](T t) { return double(t.smooth.pathTurnChanges); }},
      {"pose_error", [](T t) { return t.poseErrors.mean; }},
      {"largest_pose_error", [](T t) { return t.poseErrors.largest; }},
      {"odometry_error", [](T t) { return t.odometryErrors.mean; }},
      {"cycle", [](T t) { return t.cycle; }},
      {"slow_cycle", [](T t) { return t.slowCycle; }},
      {"leaves", [](T t) { return t.leaves; }},
      {"processor", [](T t) { return t.processorSeconds; }}};
  return columns;
}

}  // namespace

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
  DriveLoop loop(config, world, order, task.start, task.goal, {});
  const DriveRecord& record = loop.run();
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

std::string toCsv(const std::vector<Trial>& trials) {
  std::ostringstream out;
  out << "scene,number,path,end,fault,why_no_path,reason";
  for (const Column& column : columns()) out << ',' << column.name;
  for (const Trial& t : trials) {
    out << '\n'
        << t.scene << ',' << t.number << ',' << (t.task.hasPath ? "yes" : "no") << ','
        << nameOf(t.end) << ',' << t.fault() << ',' << csvField(t.task.reason) << ','
        << csvField(t.reason);
    for (const Column& column : columns()) out << ',' << column.of(t);
  }
  out << '\n';
  return out.str();
}

}  // namespace drive_study
