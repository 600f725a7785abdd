#include "LeafContent.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace semantic_octree {

Belief truncated(std::vector<ClassLogOdds> named, double rest, int numClasses) {
  std::sort(named.begin(), named.end(), [](const ClassLogOdds& a, const ClassLogOdds& b) {
    return a.logOdds != b.logOdds ? a.logOdds > b.logOdds : a.id < b.id;
  });
  Belief belief;
  const std::size_t kept = std::min(named.size(), belief.ids.size());
  for (; belief.count < kept; ++belief.count) {
    belief.ids[belief.count] = named[belief.count].id;
    belief.logOdds[belief.count] = onGrid(named[belief.count].logOdds);
  }
  if (named.size() > kept) {
    double odds = (numClasses - static_cast<double>(named.size())) * std::exp(rest);
    for (std::size_t i = kept; i < named.size(); ++i) odds += std::exp(named[i].logOdds);
    rest = std::log(odds / belief.unnamed(numClasses));
  }
  belief.rest = onGrid(rest);
  belief.sort();
  return belief;
}

LeafContent contentOf(const SemanticOcTree& map, const Node& node) {
  LeafContent content{node.getValue(), std::nullopt};
  if (node.hasClassRecord()) {
    content.record = map.belief(node);
  } else if (map.query(node).likeliestClass != kNoClass) {
    const std::vector<double> p = map.distribution(node);
    const double occupied = std::accumulate(p.begin() + 1, p.end(), 0.0);
    const auto logOdds = [&](double share) {
      return content.occupancyLogOdds + std::log(std::max(share / occupied, 1e-12));
    };
    std::vector<ClassLogOdds> named;
    for (int k = 1; k <= map.numClasses(); ++k)
      named.push_back({logOdds(p[k]), static_cast<ClassId>(k)});
    content.record = truncated(std::move(named), logOdds(0), map.numClasses());
  }
  return content;
}

}  // namespace semantic_octree
