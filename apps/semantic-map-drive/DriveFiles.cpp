#include "DriveFiles.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace semantic_map_drive {

using semantic_planning::DriveController;
using synthetic_world::classTable;

namespace {

std::string nameOfClass(std::size_t id) {
  return id == 0 ? "unknown" : classTable().name(static_cast<semantic_octree::ClassId>(id));
}

nlohmann::json lengthsToJson(const std::vector<double>& perClass) {
  nlohmann::json lengths = nlohmann::json::object();
  for (std::size_t id = 0; id < perClass.size(); ++id)
    if (perClass[id] > 0) lengths[nameOfClass(id)] = perClass[id];
  return lengths;
}

nlohmann::json timesToJson(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const auto at = [&times](double share) {
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  return {{"cycles", times.size()}, {"median", at(0.5)}, {"p95", at(0.95)}, {"max", times.back()}};
}

}  // namespace

std::string toCsv(const DriveRecord& record) {
  std::ostringstream out;
  out << "time,x,y,z,heading,speed,turn,class,clearance,offset,target,driver\n";
  for (const DriveRow& r : record.rows) {
    out << r.time << ',' << r.pose.x << ',' << r.pose.y << ',' << r.z << ','
        << r.pose.phi * 180 / M_PI << ',' << r.speed << ',' << r.turn << ','
        << nameOfClass(r.classId) << ',' << r.clearance << ',' << r.offset << ','
        << nameOf(r.target) << ','
        << (r.driver == DriveController::Driver::Reactive ? "reactive" : "path") << '\n';
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
  for (const auto& [stage, times] : record.times) json["milliseconds"][stage] = timesToJson(times);
  return json;
}

double badLength(const std::vector<double>& perClass, const colored_graph::ClassOrder& order) {
  double sum = 0;
  for (std::size_t id = 0; id < perClass.size(); ++id)
    if (order.rank(static_cast<colored_graph::ClassId>(id)) != 0) sum += perClass[id];
  return sum;
}

}  // namespace semantic_map_drive
