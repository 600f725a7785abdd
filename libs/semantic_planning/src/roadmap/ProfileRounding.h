#pragma once
#include <colored_graph/ColoredGraph.h>

#include <algorithm>
#include <vector>

namespace semantic_planning {

/** Lengths by class, meters, in the graph's units. */
inline colored_graph::EdgeProfile roundedDown(const std::vector<double>& lengths) {
  colored_graph::EdgeProfile profile;
  for (std::size_t id = 0; id < lengths.size(); ++id)
    if (lengths[id] > 0)
      profile.push_back(
          {static_cast<colored_graph::GraphClass>(id), colored_graph::lengthDown(lengths[id])});
  return profile;
}

/** They add up to the total. */
inline colored_graph::EdgeProfile rounded(const std::vector<double>& lengths, double total) {
  colored_graph::EdgeProfile profile = roundedDown(lengths);
  colored_graph::Length left = colored_graph::lengthUp(total);
  for (auto& stretch : profile) left -= stretch.length = std::min(left, stretch.length);
  const auto longest =
      std::max_element(profile.begin(), profile.end(),
                       [](const auto& l, const auto& r) { return l.length < r.length; });
  if (longest != profile.end()) longest->length += left;
  return profile;
}

}  // namespace semantic_planning
