#include <semantic_planning/planner/OrderAbstraction.h>

namespace semantic_planning {

semantic_octree::AbstractionOptions abstractionFor(const colored_graph::ClassOrder& order,
                                                   double alpha) {
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
  options.weights.alpha = alpha;
  return options;
}

}  // namespace semantic_planning
