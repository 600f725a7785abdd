#include "PointQuery.h"

#include <iomanip>
#include <ostream>

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
    case CellState::Status::Unknown:
      break;
  }
  return "unknown";
}

}  // namespace

void answerPoints(const semantic_octree::SemanticOcTree& map,
                  const std::vector<strict_files::TextLine>& points, std::ostream& out) {
  for (const strict_files::TextLine& line : points) {
    const std::vector<double> p = numbersOf(line, 3);
    const CellState state = map.query(p[0], p[1], p[2]);
    const bool seen = state.likeliestClass != kNoClass;
    out << std::setprecision(10) << p[0] << '\t' << p[1] << '\t' << p[2] << '\t'
        << nameOf(state.status) << '\t' << int{state.likeliestClass} << '\t'
        << (seen ? map.classes().name(state.likeliestClass) : "-") << '\t' << std::setprecision(6)
        << state.probability << '\t' << state.occupancy << '\n';
  }
}

}  // namespace semantic_map_info
