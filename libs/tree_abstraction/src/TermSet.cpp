#include <tree_abstraction/AbstractionWeights.h>

#include <algorithm>

namespace tree_abstraction {
namespace {

/** The classes 0..K that are in none of the groups. */
std::vector<int> classesLeftOver(const std::vector<std::vector<int>>& groups, int numClasses) {
  std::vector<int> rest;
  for (int id = 0; id <= numClasses; ++id) {
    const auto holdsId = [id](const std::vector<int>& group) {
      return std::find(group.begin(), group.end(), id) != group.end();
    };
    if (std::none_of(groups.begin(), groups.end(), holdsId)) rest.push_back(id);
  }
  return rest;
}

}  // namespace

TermSet::TermSet(const AbstractionWeights& weights, int numClasses) : m_numClasses(numClasses) {
  weights.validate(numClasses);
  for (const auto& term : weights.terms) {
    auto outcomes = term.groups;
    const auto rest = classesLeftOver(term.groups, numClasses);
    if (term.groups.size() > 1 && !rest.empty()) outcomes.push_back(rest);
    m_slots.push_back({m_width, outcomes.size()});
    for (const auto& outcome : outcomes) {
      for (const int id : outcome) {
        m_contributions.push_back({static_cast<std::size_t>(id), m_width});
      }
      ++m_width;
    }
  }
}

}  // namespace tree_abstraction
