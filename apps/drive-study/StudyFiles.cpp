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

void addPose(std::ostream& out, const mrpt::math::TPose2D& pose) {
  out << pose.x << ',' << pose.y << ',' << pose.phi * 180 / M_PI << ',';
}

/** Seconds from when the goal was seen, of the unfit ones. */
double latestRefusal(const std::vector<Trial>& trials) {
  double latest = 0;
  for (const Trial& t : trials)
    if (t.task.unfit && t.seenAt >= 0) latest = std::max(latest, t.refusedAt - t.seenAt);
  return latest;
}

double largestJerk(const std::vector<Trial>& trials) {
  double largest = 0;
  for (const Trial& t : trials) largest = std::max(largest, t.smooth.jerk);
  return largest;
}

double longestBackwards(const std::vector<Trial>& trials) {
  double longest = 0;
  for (const Trial& t : trials) longest = std::max(longest, t.smooth.longestBackwards);
  return longest;
}

ordered_json summaryOf(const std::vector<Trial>& trials) {
  const auto count = [&trials](auto isOne) {
    return std::count_if(trials.begin(), trials.end(), isOne);
  };
  const auto sum = [&trials](auto of) {
    double total = 0;
    for (const Trial& t : trials) total += of(t);
    return total;
  };
  double least = std::numeric_limits<double>::infinity();
  for (const Trial& t : trials) least = std::min(least, t.leastClearance);
  const auto arrived = [](const Trial& t) { return t.end == DriveEnd::Arrived; };
  return {
      {"drives", trials.size()},
      {"withPath", count([](const Trial& t) { return t.task.hasPath; })},
      {"arrivedOfThese", count([&](const Trial& t) { return t.task.hasPath && arrived(t); })},
      {"withoutPath", count([](const Trial& t) { return !t.task.hasPath; })},
      {"saidSo", count([](const Trial& t) { return !t.task.hasPath && t.saidSo(); })},
      {"unfit", count([](const Trial& t) { return t.task.unfit; })},
      {"refusedOfThese", count([](const Trial& t) { return t.task.unfit && t.refusedAt >= 0; })},
      {"latestRefusal", latestRefusal(trials)},
      {"arrivedNevertheless", count([&](const Trial& t) { return !t.task.hasPath && arrived(t); })},
      {"collisions", sum([](const Trial& t) { return t.collisions; })},
      {"leastClearance", least},
      {"meters", sum([](const Trial& t) { return t.length; })},
      {"metersBackwards", sum([](const Trial& t) { return t.smooth.backwards; })},
      {"longestBackwards", longestBackwards(trials)},
      {"gearChanges", sum([](const Trial& t) { return t.smooth.gearChanges; })},
      {"turnSignChanges", sum([](const Trial& t) { return t.smooth.turnChanges; })},
      {"turnSignChangesOfPaths", sum([](const Trial& t) { return t.smooth.pathTurnChanges; })},
      {"largestJerk", largestJerk(trials)},
      {"metersInWorseClasses", sum([](const Trial& t) { return t.badDriven; })},
      {"metersInWorseClassesPlanned", sum([](const Trial& t) { return t.badFollowed; })},
      {"faults", count([](const Trial& t) { return !t.fault().empty(); })},
      {"processorSeconds", sum([](const Trial& t) { return t.processorSeconds; })}};
}

}  // namespace

std::string toCsv(const std::vector<Trial>& trials) {
  std::ostringstream out;
  out << "scene,number,start_x,start_y,start_deg,goal_x,goal_y,goal_deg,path,path_length,"
         "path_worse,end,fault,seconds,length,worse,worse_planned,collisions,clearance,replans,"
         "explored,seen,refused,jerk,backwards,longest_backwards,gear_changes,turn_changes,path_"
         "turn_changes,"
         "pose_error,largest_pose_error,odometry_error,cycle,slow_cycle,leaves,processor,why_no_"
         "path,"
         "reason\n";
  for (const Trial& t : trials) {
    out << t.scene << ',' << t.number << ',';
    addPose(out, t.task.start);
    addPose(out, t.task.goal);
    out << (t.task.hasPath ? "yes" : "no") << ',' << t.task.length << ',' << t.badBest << ','
        << nameOf(t.end) << ',' << t.fault() << ',' << t.seconds << ',' << t.length << ','
        << t.badDriven << ',' << t.badFollowed << ',' << t.collisions << ',' << t.leastClearance
        << ',' << t.replans << ',' << t.explored << ',' << t.seenAt << ',' << t.refusedAt << ','
        << t.smooth.jerk << ',' << t.smooth.backwards << ',' << t.smooth.longestBackwards << ','
        << t.smooth.gearChanges << ',' << t.smooth.turnChanges << ',' << t.smooth.pathTurnChanges
        << ',' << t.poseErrors.mean << ',' << t.poseErrors.largest << ',' << t.odometryErrors.mean
        << ',' << t.cycle << ',' << t.slowCycle << ',' << t.leaves << ',' << t.processorSeconds
        << ',' << csvField(t.task.reason) << ',' << csvField(t.reason) << '\n';
  }
  return out.str();
}

ordered_json toJson(const std::vector<Trial>& trials) {
  std::vector<std::string> scenes;
  for (const Trial& t : trials)
    if (std::find(scenes.begin(), scenes.end(), t.scene) == scenes.end()) scenes.push_back(t.scene);
  ordered_json study;
  for (const std::string& scene : scenes) {
    std::vector<Trial> some;
    for (const Trial& t : trials)
      if (t.scene == scene) some.push_back(t);
    study[scene] = summaryOf(some);
  }
  study["all"] = summaryOf(trials);
  return study;
}

std::string toMarkdown(const ordered_json& study) {
  std::ostringstream out;
  out << "| scene |";
  for (const auto& [name, value] : study["all"].items()) out << ' ' << name << " |";
  out << "\n|---|";
  for (std::size_t i = 0; i < study["all"].size(); ++i) out << "---|";
  out << '\n';
  for (const auto& [scene, numbers] : study.items()) {
    out << "| " << scene << " |";
    for (const auto& value : numbers) {
      const double number = value.get<double>();
      out << ' ' << std::round(number * 100) / 100 << " |";
    }
    out << '\n';
  }
  return out.str();
}

}  // namespace drive_study
