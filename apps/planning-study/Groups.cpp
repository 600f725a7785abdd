#include "Groups.h"

namespace planning_study {

Groups groupsOf(const std::vector<Trial>& trials) {
  Groups groups;
  for (const Trial& t : trials) groups[{t.judgment, t.graph, t.budget, t.kept}][t.instance] = &t;
  return groups;
}

const std::vector<std::pair<const char*, Measure>>& stages() {
  static const std::vector<std::pair<const char*, Measure>> stages = {
      {"graph", [](const Trial& t) { return t.graphTime; }},
      {"evaluation", [](const Trial& t) { return t.evaluationTime; }},
      {"search", [](const Trial& t) { return t.searchTime; }},
      {"planning", [](const Trial& t) { return t.planningTime(); }},
      {"total", [](const Trial& t) { return t.totalTime(); }},
      {"firstPath", [](const Trial& t) { return t.timeToFirstPath(); }}};
  return stages;
}

double metersOutsideBest(const Trial& trial) {
  Length sum = 0;
  for (std::size_t i = 0; i + 1 < trial.way.size(); ++i) sum += trial.way[i];
  return colored_graph::toMeters(sum);
}

double weightedMeters(const Trial& trial) {
  double sum = meters(trial), weight = 1;
  for (auto length = trial.way.rbegin() + 1; length != trial.way.rend(); ++length) {
    weight *= 10;
    sum += (weight - 1) * colored_graph::toMeters(*length);  // the total has it once
  }
  return sum;
}

double edgesEvaluated(const Trial& trial) { return static_cast<double>(trial.evaluated); }

double meters(const Trial& trial) { return colored_graph::toMeters(trial.way.back()); }

std::vector<double> sampleOf(const Group& group, Measure measure) {
  std::vector<double> sample;
  for (const auto& [instance, trial] : group)
    if (trial->found) sample.push_back(measure(*trial));
  return sample;
}

std::size_t countFound(const Group& group) {
  std::size_t count = 0;
  for (const auto& [instance, trial] : group) count += trial->found;
  return count;
}

Pairs pairsOf(const Group& a, const Group& b) {
  Pairs pairs;
  for (const auto& [instance, trial] : a) {
    const auto other = b.find(instance);
    if (other == b.end()) continue;
    pairs.all.emplace_back(trial, other->second);
    if (trial->found && other->second->found) pairs.solved.emplace_back(trial, other->second);
  }
  return pairs;
}

}  // namespace planning_study
