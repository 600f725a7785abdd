#pragma once
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "Statistics.h"
#include "Trial.h"

namespace planning_study {

/** One way to plan. */
struct GroupKey {
  std::string judgment, graph;
  std::size_t budget = 0;
  bool kept = false;  ///< Trial::kept
  bool operator<(const GroupKey& o) const {
    return std::tie(judgment, graph, budget, kept) <
           std::tie(o.judgment, o.graph, o.budget, o.kept);
  }
};

/** Its trials, by instance. */
using Group = std::map<std::size_t, const Trial*>;
using Groups = std::map<GroupKey, Group>;
/** \param trials of one map; must outlive the groups. */
Groups groupsOf(const std::vector<Trial>& trials);

/** Numbers of a trial that are summarized, with their names. */
using Measure = double (*)(const Trial&);
const std::vector<std::pair<const char*, Measure>>& stages();  ///< processor milliseconds
double metersOutsideBest(const Trial& trial);  ///< along the path, in all ranks but the best
double meters(const Trial& trial);             ///< of the path
double weightedMeters(const Trial& trial);     ///< what the peers minimize: rank k weighs 10^k
double edgesEvaluated(const Trial& trial);

/** A measure of the trials of a group that found a path. */
std::vector<double> sampleOf(const Group& group, Measure measure);
std::size_t countFound(const Group& group);

/** Two ways to plan the same instances. */
struct Pairs {
  std::vector<std::pair<const Trial*, const Trial*>> all;     ///< tried by both
  std::vector<std::pair<const Trial*, const Trial*>> solved;  ///< by both
};
Pairs pairsOf(const Group& a, const Group& b);

}  // namespace planning_study
