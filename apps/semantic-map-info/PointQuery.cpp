#include "PointQuery.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace semantic_map_info {

using nlohmann::ordered_json;
using semantic_octree::CellState;
using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;
using semantic_types::kNoClass;

namespace {

using Point = std::vector<double>;  // x, y, z, m

const char* nameOf(CellState::Status status) {
  switch (status) {
    case CellState::Status::Free:
      return "free";
    case CellState::Status::Occupied:
      return "occupied";
    case CellState::Status::Unknown:
      break;
  }
  return "unknown";
}

ordered_json distributionAt(const SemanticOcTree& map, const Point& p) {
  ordered_json json = ordered_json::array();
  octomap::OcTreeKey key;
  SemanticOcTree::Node node;
  if (map.coordToKeyChecked(p[0], p[1], p[2], key)) node = map.search(key);
  if (!node) return json;
  const std::vector<double> all = map.distribution(node);
  for (std::size_t id = 0; id < all.size(); ++id)
    if (std::round(all[id] * 1e6) > 0)
      json.push_back({{"class", id == 0 ? "(free)" : map.classes().name(static_cast<ClassId>(id))},
                      {"probability", all[id]}});
  return json;
}

ordered_json answerAt(const SemanticOcTree& map, const Point& p, bool distribution) {
  const CellState state = map.query(p[0], p[1], p[2]);
  const bool seen = state.likeliestClass != kNoClass;
  ordered_json answer = {{"x", p[0]},
                         {"y", p[1]},
                         {"z", p[2]},
                         {"state", nameOf(state.status)},
                         {"id", int{state.likeliestClass}},
                         {"class", seen ? map.classes().name(state.likeliestClass) : "-"},
                         {"probability", state.probability},
                         {"occupancy", state.occupancy}};
  if (distribution) answer["distribution"] = distributionAt(map, p);
  return answer;
}

}  // namespace

ordered_json answersAt(const SemanticOcTree& map, const std::vector<strict_files::TextLine>& lines,
                       bool distribution) {
  ordered_json answers = ordered_json::array();
  for (const strict_files::TextLine& line : lines)
    answers.push_back(answerAt(map, numbersOf(line, 3), distribution));
  return answers;
}

std::string textOfAnswers(const ordered_json& answers) {
  std::ostringstream out;
  const auto text = [](const ordered_json& value) { return value.get_ref<const std::string&>(); };
  const auto number = [](const ordered_json& value) { return value.get<double>(); };
  for (const ordered_json& a : answers) {
    out << std::setprecision(10) << number(a["x"]) << '\t' << number(a["y"]) << '\t'
        << number(a["z"]) << '\t' << text(a["state"]) << '\t' << a["id"] << '\t' << text(a["class"])
        << '\t' << std::setprecision(6) << number(a["probability"]) << '\t'
        << number(a["occupancy"]) << '\n';
    if (!a.contains("distribution")) continue;
    for (const ordered_json& part : a["distribution"])
      out << '\t' << number(part["probability"]) << '\t' << text(part["class"]) << '\n';
  }
  return out.str();
}

}  // namespace semantic_map_info
