#include "DriveFiles.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "measuring/Quantile.h"

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

nlohmann::json timesToJson(const std::vector<double>& times) {
  return {{"cycles", times.size()},
          {"median", measuring::quantile(times, 0.5)},
          {"p95", measuring::quantile(times, 0.95)},
          {"max", measuring::quantile(times, 1)}};
}

/** How far poses of the rows are from the true ones. */
nlohmann::json errorsToJson(const std::vector<DriveRow>& rows, TPose2D DriveRow::*pose) {
  double sum = 0, largest = 0, turns = 0;
  for (const DriveRow& r : rows) {
    const TPose2D& p = r.*pose;
    const double error = std::hypot(p.x - r.pose.x, p.y - r.pose.y);
    sum += error;
    largest = std::max(largest, error);
    turns += std::abs(mrpt::math::wrapToPi(p.phi - r.pose.phi));
  }
  const double count = std::max<double>(1, static_cast<double>(rows.size()));
  return {{"mean", sum / count}, {"largest", largest}, {"meanHeading", turns / count * 180 / M_PI}};
}

}  // namespace

std::string toCsv(const DriveRecord& record) {
  std::ostringstream out;
  out << "time,x,y,z,heading,speed,turn,class,clearance,offset,target,driver,believedX,believedY,"
         "believedHeading\n";
  for (const DriveRow& r : record.rows) {
    out << r.time << ',' << r.pose.x << ',' << r.pose.y << ',' << r.z << ','
        << r.pose.phi * 180 / M_PI << ',' << r.speed << ',' << r.turn << ','
        << nameOfClass(r.classId) << ',' << r.clearance << ',' << r.offset << ','
        << nameOf(r.target) << ',' << nameOf(r.driver) << ',' << r.believed.x << ',' << r.believed.y
        << ',' << r.believed.phi * 180 / M_PI << '\n';
  }
  return out.str();
}

nlohmann::json toJson(const DriveRecord& record, const colored_graph::ClassOrder& order) {
  nlohmann::json json;
  json["end"] = nameOf(record.end);
  json["reached"] = record.arrived();
  if (!record.reason.empty()) json["reason"] = record.reason;
  json["seconds"] = record.duration();
  json["meters"] = record.length;
  json["metersPerClass"] = lengthsToJson(record.drivenPerClass);
  json["metersPerClassPlanned"] = lengthsToJson(record.plannedPerClass);
  json["metersInWorseClasses"] = badLength(record.drivenPerClass, order);
  json["metersInWorseClassesPlanned"] = badLength(record.plannedPerClass, order);
  json["replans"] = record.replans;
  json["collisions"] = record.collisions;
  json["leastClearance"] = record.leastClearance;
  if (!record.exactPose)
    json["poseError"] = {{"believed", errorsToJson(record.rows, &DriveRow::believed)},
                         {"odometry", errorsToJson(record.rows, &DriveRow::odometry)}};
  for (const auto& [stage, times] : record.times) json["milliseconds"][stage] = timesToJson(times);
  return json;
}

double badLength(const std::vector<double>& perClass, const colored_graph::ClassOrder& order) {
  double sum = 0;
  for (std::size_t id = 0; id < perClass.size(); ++id)
    if (order.rank(static_cast<colored_graph::GraphClass>(id)) != 0) sum += perClass[id];
  return sum;
}

}  // namespace simulated_drive
