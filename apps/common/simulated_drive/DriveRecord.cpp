#include "DriveRecord.h"

#include <mrpt/math/wrap2pi.h>
#include <synthetic_world/Solids.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "measuring/Measuring.h"

namespace simulated_drive {

using mrpt::math::TPose2D;
using synthetic_world::classTable;

namespace {

std::string nameOfClass(std::size_t id) {
  return id == 0 ? "unknown" : classTable().name(static_cast<semantic_types::ClassId>(id));
}

nlohmann::json lengthsToJson(const std::vector<double>& perClass) {
  nlohmann::json lengths = nlohmann::json::object();
  for (std::size_t id = 0; id < perClass.size(); ++id)
    if (perClass[id] > 0) lengths[nameOfClass(id)] = perClass[id];
  return lengths;
}

nlohmann::json poseToJson(const TPose2D& pose) { return {pose.x, pose.y, pose.phi * 180 / M_PI}; }

/** When it was said that the goal does not fit, why, and the pose [x, y, degrees] instead. */
nlohmann::json refusalToJson(const semantic_driving::RefusedGoal& refusal) {
  nlohmann::json json = {{"seconds", refusal.seconds}, {"reason", refusal.reason}};
  if (refusal.nearest) json["nearest"] = poseToJson(*refusal.nearest);
  return json;
}

/** How often a value has another sign than before; small ones have none. */
class SignChanges {
 public:
  void add(double value, double least) {
    const int sign = value > least ? 1 : value < -least ? -1 : 0;
    if (sign == 0) return;
    if (sign == -m_last) ++m_count;
    m_last = sign;
  }
  int count() const { return m_count; }

 private:
  int m_last = 0, m_count = 0;
};

/** The share of values that are larger. */
double shareOver(const std::vector<double>& values, double most) {
  const auto above = [most](double value) { return value > most; };
  return static_cast<double>(std::count_if(values.begin(), values.end(), above)) /
         std::max<double>(1, static_cast<double>(values.size()));
}

nlohmann::json timesToJson(const std::vector<double>& times) {
  return {{"cycles", times.size()},
          {"median", measuring::quantile(times, 0.5)},
          {"p95", measuring::quantile(times, 0.95)},
          {"max", measuring::quantile(times, 1)},
          {"shareOver100", shareOver(times, 100)}};
}

nlohmann::json toJson(const PoseErrors& e) {
  return {{"mean", e.mean}, {"largest", e.largest}, {"meanHeading", e.meanHeading}};
}

}  // namespace

PoseErrors poseErrorsOf(const DriveRecord& record, TPose2D DriveRow::*pose) {
  PoseErrors errors;
  const double count = std::max<double>(1, static_cast<double>(record.rows.size()));
  for (const DriveRow& r : record.rows) {
    const TPose2D& p = r.*pose;
    const double error = std::hypot(p.x - r.pose.x, p.y - r.pose.y);
    errors.mean += error / count;
    errors.largest = std::max(errors.largest, error);
    errors.meanHeading += std::abs(mrpt::math::wrapToPi(p.phi - r.pose.phi)) * 180 / M_PI / count;
  }
  return errors;
}

double shareOfSlowCycles(const DriveRecord& record) {
  const auto cycles = record.times.find("insert+update+replan");
  return cycles == record.times.end() ? 0 : shareOver(cycles->second, 100);
}

Smoothness smoothnessOf(const DriveRecord& record) {
  constexpr double kStraight = 0.02;  // rad/s
  Smoothness s;
  const std::vector<DriveRow>& rows = record.rows;
  const auto acceleration = [&rows](std::size_t i) {
    return (rows[i].speed - rows[i - 1].speed) / (rows[i].time - rows[i - 1].time);
  };
  SignChanges turns, bends, gears;
  double stretch = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const DriveRow& row = rows[i];
    if (i > 1)
      s.jerk = std::max(
          s.jerk, std::abs(acceleration(i) - acceleration(i - 1)) / (row.time - rows[i - 1].time));
    const double back = i > 0 ? std::max(0.0, -row.speed * (row.time - rows[i - 1].time)) : 0;
    s.backwards += back;
    stretch = row.speed > kStraight ? 0 : stretch + back;
    s.longestBackwards = std::max(s.longestBackwards, stretch);
    turns.add(row.turn, kStraight);
    bends.add(row.bend * row.speed, kStraight);
    gears.add(row.speed, kStraight);
  }
  s.turnChanges = turns.count(), s.pathTurnChanges = bends.count(), s.gearChanges = gears.count();
  return s;
}

std::string toCsv(const DriveRecord& record) {
  std::ostringstream out;
  out << "time,x,y,z,heading,speed,turn,class,clearance,offset,target,driver,believedX,believedY,"
         "believedHeading\n";
  for (const DriveRow& r : record.rows) {
    out << r.time << ',' << r.pose.x << ',' << r.pose.y << ',' << r.z << ','
        << r.pose.phi * 180 / M_PI << ',' << r.speed << ',' << r.turn << ','
        << nameOfClass(r.classId) << ',' << r.clearance << ',' << r.offset << ','
        << nameOf(r.target) << ',' << (r.isReactive ? "reactive" : "path") << ',' << r.believed.x
        << ',' << r.believed.y << ',' << r.believed.phi * 180 / M_PI << '\n';
  }
  return out.str();
}

nlohmann::json toJson(const DriveRecord& record, const colored_graph::ClassOrder& order) {
  nlohmann::json json;
  json["end"] = nameOf(record.end);
  json["reached"] = record.arrived();
  if (!record.reason.empty()) json["reason"] = record.reason;
  if (record.refusal) json["refusedGoal"] = refusalToJson(*record.refusal);
  json["seconds"] = record.duration();
  json["meters"] = record.length;
  json["metersPerClass"] = lengthsToJson(record.drivenPerClass);
  json["metersPerClassPlanned"] = lengthsToJson(record.plannedPerClass);
  json["metersInWorseClasses"] = badLength(record.drivenPerClass, order);
  json["metersInWorseClassesPlanned"] = badLength(record.plannedPerClass, order);
  json["replans"] = record.replans;
  json["collisions"] = record.collisions;
  const Smoothness smooth = smoothnessOf(record);
  json["smoothness"] = {{"jerk", smooth.jerk},
                        {"metersBackwards", smooth.backwards},
                        {"longestBackwards", smooth.longestBackwards},
                        {"gearChanges", smooth.gearChanges},
                        {"turnSignChanges", smooth.turnChanges},
                        {"turnSignChangesOfPath", smooth.pathTurnChanges}};
  json["leastClearance"] = record.leastClearance;
  if (!record.exactPose)
    json["poseError"] = {{"believed", toJson(poseErrorsOf(record, &DriveRow::believed))},
                         {"odometry", toJson(poseErrorsOf(record, &DriveRow::odometry))}};
  if (!record.leaves.empty())
    json["compressedLeaves"] = {{"median", measuring::quantile(record.leaves, 0.5)},
                                {"max", measuring::quantile(record.leaves, 1)}};
  for (const auto& [stage, times] : record.times) json["milliseconds"][stage] = timesToJson(times);
  return json;
}

double badLength(const std::vector<double>& perClass, const colored_graph::ClassOrder& order) {
  double sum = 0;
  for (std::size_t id = 0; id < perClass.size(); ++id)
    if (order.rank(static_cast<colored_graph::GraphClass>(id)) != 0) sum += perClass[id];
  return sum;
}

void DriveRecord::add(const DriveRow& row, std::optional<semantic_types::ClassId> planned,
                      double way) {
  drivenPerClass[row.classId] += way;
  if (planned) plannedPerClass[*planned] += way;
  length += way;
  const bool touchedBefore = !rows.empty() && rows.back().clearance <= 0;
  if (row.clearance <= 0 && !touchedBefore) ++collisions;
  leastClearance = std::min(leastClearance, row.clearance);
  rows.push_back(row);
}

}  // namespace simulated_drive
