#include <map_view/CellSource.h>
#include <semantic_abstraction/AbstractionOptions.h>

#include <algorithm>

namespace map_view {

using semantic_octree::CellState;

CellAnswer answerOf(const ViewCell& cell, const SemanticOcTree& map) {
  constexpr double kLeast = 0.0005;
  CellAnswer answer;
  const double voxel = map.getResolution();
  answer.key = semantic_octree::octomapKey(cell.lowest.x(), cell.lowest.y(), cell.lowest.z());
  answer.center = cell.center(voxel);
  answer.size = map.getNodeSize(static_cast<unsigned>(cell.depth));
  answer.state = "unknown", answer.occupancy = 0.5;
  if (!cell.node) return answer;
  const CellState state = map.query(cell.node);
  answer.occupancy = state.occupancy;
  answer.state = state.status == CellState::Status::Free
                     ? "free"
                     : "occupied, " + map.classes().name(state.likeliestClass);
  const std::vector<double> p = map.distribution(cell.node);
  for (std::size_t k = 0; k < p.size(); ++k)
    if (p[k] >= kLeast)
      answer.shares.push_back(
          {k == 0 ? semantic_octree::kFreeSpace : map.classes().name(static_cast<ClassId>(k)),
           static_cast<ClassId>(k), p[k]});
  std::stable_sort(answer.shares.begin(), answer.shares.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  return answer;
}

}  // namespace map_view
