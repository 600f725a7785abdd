#include "Trial.h"

#include <cmath>

namespace planning_study {

double Instance::distance() const { return std::hypot(goal.x - start.x, goal.y - start.y); }

const char* memoryName(bool kept) { return kept ? "kept" : "cold"; }

std::vector<Length> wayOf(const std::vector<Length>& lengthPerClass,
                          const colored_graph::ClassOrder& order) {
  std::vector<Length> way(order.ranks());
  for (std::size_t id = 0; id < lengthPerClass.size(); ++id) {
    const auto rank = order.rank(static_cast<colored_graph::GraphClass>(id));
    way.back() += lengthPerClass[id];
    if (rank > 0 && rank < order.ranks()) way[order.ranks() - 1 - rank] += lengthPerClass[id];
  }
  return way;
}

}  // namespace planning_study
