#include "PointQuery.h"

#include <Eigen/Core>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace semantic_map_info {

using semantic_octree::CellState;
using semantic_types::kNoClass;

namespace {

const char* nameOf(CellState::Status status) {
  switch (status) {
    case CellState::Status::Free:
      return "free";
    case CellState::Status::Occupied:
      return "occupied";
    default:
      return "unknown";
  }
}

Eigen::Vector3d parsePoint(const std::string& text, const std::string& where) {
  std::istringstream stream(text);
  Eigen::Vector3d p;
  std::string rest;
  if (!(stream >> p.x() >> p.y() >> p.z()) || stream >> rest || !p.allFinite())
    throw std::runtime_error(where + ": '" + text + "', expected x y z");
  return p;
}

}  // namespace

void answerPoints(const semantic_octree::SemanticOcTree& map, std::istream& in,
                  const std::string& name, std::ostream& out) {
  std::string text;
  for (std::size_t number = 1; std::getline(in, text); ++number) {
    text.erase(std::min(text.find('#'), text.size()));
    text.erase(text.find_last_not_of(" \t\r") + 1);
    if (text.empty()) continue;
    const Eigen::Vector3d p = parsePoint(text, name + ":" + std::to_string(number));
    const CellState state = map.query(p.x(), p.y(), p.z());
    const bool seen = state.likeliestClass != kNoClass;
    out << std::setprecision(10) << p.x() << '\t' << p.y() << '\t' << p.z() << '\t'
        << nameOf(state.status) << '\t' << int{state.likeliestClass} << '\t'
        << (seen ? map.classes().name(state.likeliestClass) : "-") << '\t' << std::setprecision(6)
        << state.probability << '\t' << state.occupancy << '\n';
  }
}

}  // namespace semantic_map_info
