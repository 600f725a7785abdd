#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_planning/planner/OrderFile.h>

namespace semantic_planning {

semantic_octree::AbstractionOptions abstractionFor(const colored_graph::ClassOrder& order,
                                                   double alpha, bool obstacles) {
  std::vector<std::vector<int>> groups(order.ranks());
  for (int id = 1; id < order.classes(); ++id) {  // 0 would be free space
    const colored_graph::Rank rank = order.rank(static_cast<colored_graph::GraphClass>(id));
    if (rank != colored_graph::kForbidden) groups[rank].push_back(id);
  }
  tree_abstraction::InformationTerm ranks{"ranks", 1, {}};
  for (const std::vector<int>& group : groups)
    if (!group.empty()) ranks.groups.push_back(group);
  semantic_octree::AbstractionOptions options;
  options.blockSize = 3.2;
  options.weights.terms = {ranks};
  if (obstacles) options.weights.terms.push_back(tree_abstraction::relevant("obstacles", 1, {0}));
  options.weights.alpha = alpha;
  return options;
}

semantic_octree::AbstractionOptions abstractionOf(const std::filesystem::path& weights,
                                                  const std::string& solution,
                                                  const semantic_types::ClassTable& classes) {
  const semantic_octree::WeightsFile file = semantic_octree::loadWeights(weights, classes);
  const semantic_octree::Solution& found = file.solution(solution);
  semantic_octree::AbstractionOptions options = file.space;
  options.weights.terms = found.terms;
  options.weights.alpha = found.alpha.value_or(tree_abstraction::kPlanningAlpha);
  return options;
}

}  // namespace semantic_planning
