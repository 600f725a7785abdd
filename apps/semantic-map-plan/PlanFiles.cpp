#include "PlanFiles.h"

#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/roadmap/MrptGraph.h>
#include <strict_files/TextFile.h>

#include <cmath>
#include <iomanip>
#include <sstream>

namespace semantic_map_plan {

using nlohmann::json;
using semantic_planning::PathPoint;
using semantic_planning::PlanResult;
using semantic_types::ClassTable;

namespace {

json lengthsByName(const PlanResult& plan, const ClassTable& classes) {
  json lengths = json::object();
  for (std::size_t id = 0; id < plan.lengthPerClass.size(); ++id)
    if (plan.lengthPerClass[id] > 0)
      lengths[groundName(static_cast<semantic_types::ClassId>(id), classes)] =
          plan.lengthPerClass[id];
  return lengths;
}

/** The classes of each rank, best first. */
json ranksOf(const colored_graph::ClassOrder& order, const ClassTable& classes) {
  json ranks = json::array();
  for (int rank = 0; rank < order.ranks(); ++rank) {
    json names = json::array();
    for (int id = 0; id < order.classes(); ++id)
      if (order.rank(static_cast<colored_graph::GraphClass>(id)) == rank)
        names.push_back(groundName(static_cast<semantic_types::ClassId>(id), classes));
    ranks.push_back(names);
  }
  return ranks;
}

json timesOf(const semantic_planning::StageTimes& times) {
  json stages = json::object();
  for (const auto& [stage, milliseconds] : times) stages[stage] = milliseconds;
  return stages;
}

}  // namespace

std::string groundName(semantic_types::ClassId id, const ClassTable& classes) {
  return id == semantic_types::kNoClass ? semantic_planning::kUnknownGround : classes.name(id);
}

std::string toCsv(const PlanResult& plan, const ClassTable& classes) {
  std::ostringstream out;
  out << "x,y,z,heading,curvature,gear,class,arc_length\n" << std::fixed << std::setprecision(4);
  for (const PathPoint& p : plan.path)
    out << p.x << ',' << p.y << ',' << p.z << ',' << p.heading * 180 / M_PI << ',' << p.curvature
        << ',' << (p.forward ? "forward" : "backward") << ','
        << strict_files::csvField(groundName(p.classId, classes)) << ',' << p.arcLength << '\n';
  return out.str();
}

json toJson(const PlanResult& plan, const colored_graph::ClassOrder& order,
            const ClassTable& classes) {
  return {{"status", nameOf(plan.status)},
          {"reason", plan.reason},
          {"cost", plan.cost},
          {"price", plan.price},
          {"graphCost", plan.numVertices > 0 ? plan.cost : std::vector<std::int64_t>()},
          {"ranks", ranksOf(order, classes)},
          {"length", plan.length},
          {"lengthPerClass", lengthsByName(plan, classes)},
          {"vertices", plan.numVertices},
          {"edges", plan.numEdges},
          {"edgesEvaluated", plan.search.edgesEvaluated},
          {"expansions", plan.search.expansions},
          {"milliseconds", timesOf(plan.times)}};
}

void saveNetwork(const semantic_planning::Roadmap& roadmap, const ClassTable& classes,
                 const std::filesystem::path& file) {
  std::vector<std::string> names;
  for (int id = 0; id <= classes.size(); ++id)
    names.push_back(groundName(static_cast<semantic_types::ClassId>(id), classes));
  std::ostringstream out;
  out << std::setprecision(10);
  toNetwork(roadmap, names).writeAsText(out);
  strict_files::writeText(file, out.str());
}

}  // namespace semantic_map_plan
