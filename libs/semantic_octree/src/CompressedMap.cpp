#include <semantic_octree/Abstraction.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "OptimalTree.h"

namespace semantic_octree {
namespace {

/** Class record of a leaf with this occupancy and these probabilities of the classes, [0] is not
 * used: the likeliest by name, the mean of the rest's odds for the rest. */
Belief beliefOf(float occupancyLogOdds, const std::vector<double>& p) {
  const int K = static_cast<int>(p.size()) - 1;
  const double occupied = std::accumulate(p.begin() + 1, p.end(), 0.0);
  std::vector<ClassId> order(K);
  std::iota(order.begin(), order.end(), ClassId{1});
  const int named = std::min<int>(3, K);
  std::partial_sort(order.begin(), order.begin() + named, order.end(),
                    [&](ClassId i, ClassId j) { return p[i] != p[j] ? p[i] > p[j] : i < j; });
  const auto logOdds = [&](double share) {
    return static_cast<float>(occupancyLogOdds + std::log(std::max(share, 1e-12)));
  };
  Belief belief;
  double rest = 0;
  for (int i = named; i < K; ++i) rest += p[order[i]] / occupied;
  for (; belief.count < named; ++belief.count) {
    belief.ids[belief.count] = order[belief.count];
    belief.logOdds[belief.count] = logOdds(p[order[belief.count]] / occupied);
  }
  belief.rest = logOdds(K > named ? rest / (K - named) : 0.0);
  belief.sort();
  return belief;
}

}  // namespace

SemanticOcTree Abstraction::compressedMap() const {
  SemanticOcTree compressed(m_map.getResolution(), m_map.classes(), m_map.filterParameters());
  if (m_map.empty()) return compressed;
  NodeStore& store = *compressed.m_store;
  NodeArena& arena = store.arena(0);
  const OptimalTree optimal(*m_map.m_store, m_upkeep);
  const auto copy = [&](const auto& self, const Node& from, Node& to) -> void {
    to.setValue(from.getValue());
    if (optimal.isExpanded(from)) {
      Octant& octant = arena.createOctant(to);
      for (int i = 0; i < 8; ++i)
        if (const Node* child = NodeStore::child(from, i))
          self(self, *child, arena.createChild(octant, i));
    } else if (from.hasClassRecord()) {
      arena.setRecord(to, m_map.m_store->record(from));
    } else if (m_map.query(from).likeliestClass != kNoClass) {
      arena.setRecord(to, beliefOf(from.getValue(), m_map.distribution(from)));
    }
  };
  copy(copy, *m_map.root(), store.root());
  compressed.attachRoot();
  return compressed;
}

}  // namespace semantic_octree
