#include "StudyFiles.h"

#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace drive_study {

using nlohmann::ordered_json;
using simulated_drive::DriveEnd;
using strict_files::csvField;

namespace {

/** What a scene's drives come to. */
enum class Sum { None, Total, Least, Most };

/** A number of each drive. */
struct Column {
  const char* name;
  double (*of)(const Trial&);
  Sum sum = Sum::None;
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
      {"seconds", [](T t) { return t.seconds; }, Sum::Total},
      {"length", [](T t) { return t.length; }, Sum::Total},
      {"worse", [](T t) { return t.badDriven; }, Sum::Total},
      {"worse_planned", [](T t) { return t.badFollowed; }, Sum::Total},
      {"collisions", [](T t) { return double(t.collisions); }, Sum::Total},
      {"clearance", [](T t) { return t.leastClearance; }, Sum::Least},
      {"replans", [](T t) { return double(t.replans); }, Sum::Total},
      {"explored", [](T t) { return double(t.explored); }, Sum::Total},
      {"seen", [](T t) { return t.seenAt; }},
      {"refused", [](T t) { return t.refusedAt; }},
      {"jerk", [](T t) { return t.smooth.jerk; }, Sum::Most},
      {"backwards", [](T t) { return t.smooth.backwards; }, Sum::Total},
      {"longest_backwards", [](T t) { return t.smooth.longestBackwards; }, Sum::Most},
      {"gear_changes", [](T t) { return double(t.smooth.gearChanges); }, Sum::Total},
      {"turn_changes", [](T t) { return double(t.smooth.turnChanges); }, Sum::Total},
      {"path_turn_changes", [](T t) { return double(t.smooth.pathTurnChanges); }, Sum::Total},
      {"pose_error", [](T t) { return t.poseErrors.mean; }},
      {"largest_pose_error", [](T t) { return t.poseErrors.largest; }, Sum::Most},
      {"odometry_error", [](T t) { return t.odometryErrors.mean; }},
      {"cycle", [](T t) { return t.cycle; }},
      {"slow_cycle", [](T t) { return t.slowCycle; }, Sum::Most},
      {"leaves", [](T t) { return t.leaves; }},
      {"processor", [](T t) { return t.processorSeconds; }, Sum::Total}};
  return columns;
}

double sumOf(const std::vector<Trial>& trials, const Column& column) {
  double sum = column.sum == Sum::Least ? HUGE_VAL : 0;
  for (const Trial& t : trials) {
    const double value = column.of(t);
    sum = column.sum == Sum::Total   ? sum + value
          : column.sum == Sum::Least ? std::min(sum, value)
                                     : std::max(sum, value);
  }
  return sum;
}

ordered_json summaryOf(const std::vector<Trial>& trials) {
  const auto count = [&trials](auto isOne) {
    return std::count_if(trials.begin(), trials.end(), isOne);
  };
  using T = const Trial&;
  const auto arrived = [](T t) { return t.end == DriveEnd::Arrived; };
  ordered_json json = {
      {"drives", trials.size()},
      {"withPath", count([](T t) { return t.task.hasPath; })},
      {"arrivedOfThese", count([&](T t) { return t.task.hasPath && arrived(t); })},
      {"withoutPath", count([](T t) { return !t.task.hasPath; })},
      {"saidSo", count([](T t) { return !t.task.hasPath && t.saidSo(); })},
      {"unfit", count([](T t) { return t.task.unfit; })},
      {"refusedOfThese", count([](T t) { return t.task.unfit && t.refusedAt >= 0; })},
      {"arrivedNevertheless", count([&](T t) { return !t.task.hasPath && arrived(t); })},
      {"faults", count([](T t) { return !t.fault().empty(); })}};
  for (const Column& column : columns())
    if (column.sum != Sum::None) json[column.name] = sumOf(trials, column);
  return json;
}

}  // namespace

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

ordered_json toJson(const std::vector<Trial>& trials) {
  std::map<std::string, std::vector<Trial>> scenes;
  for (const Trial& t : trials) scenes[t.scene].push_back(t);
  ordered_json study;
  for (const auto& [scene, some] : scenes) study[scene] = summaryOf(some);
  study["all"] = summaryOf(trials);
  return study;
}

}  // namespace drive_study
