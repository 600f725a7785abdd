#include <tree_abstraction/AbstractionWeights.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace tree_abstraction {

namespace {

[[noreturn]] void reject(const std::string& field, const std::string& what) {
  throw std::invalid_argument("AbstractionWeights: " + field + ": " + what);
}

std::string quoted(const InformationTerm& term) { return "term '" + term.name + "'"; }

void requireFinite(const std::string& field, double value) {
  if (!std::isfinite(value)) reject(field, std::to_string(value) + " is not a finite number");
}

void requireNotNegative(const std::string& field, double value) {
  requireFinite(field, value);
  if (value < 0) reject(field, std::to_string(value) + " is negative");
}

void validateGroups(const InformationTerm& term, int numClasses) {
  if (term.groups.empty()) reject(quoted(term) + ", groups", "no group of classes");
  std::set<int> seen;
  for (const auto& group : term.groups) {
    if (group.empty()) reject(quoted(term) + ", groups", "a group without a class");
    for (const int id : group) {
      const std::string name = quoted(term) + ", class " + std::to_string(id);
      if (id < 0 || id > numClasses) reject(name, "not in 0.." + std::to_string(numClasses));
      if (!seen.insert(id).second) reject(name, "in more than one group");
    }
  }
}

}  // namespace

InformationTerm relevant(std::string name, double beta, std::vector<int> classes) {
  requireNotNegative("weight of relevant '" + name + "'", beta);
  return {std::move(name), beta, {std::move(classes)}};
}

InformationTerm irrelevant(std::string name, double gamma, std::vector<int> classes) {
  requireNotNegative("weight of irrelevant '" + name + "'", gamma);
  return {std::move(name), 0.0 - gamma, {std::move(classes)}};
}

InformationTerm wholeClassVariable(std::string name, double weight, int numClasses) {
  InformationTerm term{std::move(name), weight, {}};
  for (int id = 0; id <= numClasses; ++id) term.groups.push_back({id});
  return term;
}

void AbstractionWeights::validate(int numClasses) const {
  requireNotNegative("alpha", alpha);
  std::set<std::string> names;
  for (const auto& term : terms) {
    requireFinite(quoted(term) + ", weight", term.weight);
    if (!names.insert(term.name).second) reject(quoted(term), "two terms of this name");
    validateGroups(term, numClasses);
  }
}

double AbstractionWeights::eps() const {
  // About a thousand roundings of the largest value that enters a G-value.
  constexpr double kRelativeEps = 1e-12;
  double sum = alpha;
  for (const auto& term : terms) sum += std::abs(term.weight);
  return kRelativeEps * sum;
}

double TreeMeasures::objective(const AbstractionWeights& weights) const {
  double j = -weights.alpha * leafEntropy;
  for (std::size_t t = 0; t < information.size(); ++t)
    j += weights.terms[t].weight * information[t];
  return j;
}

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
