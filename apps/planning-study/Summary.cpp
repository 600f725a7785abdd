#include "Summary.h"

#include "Groups.h"
#include "JsonFile.h"
#include "RoadmapSearch.h"

namespace planning_study {

using nlohmann::ordered_json;

namespace {

ordered_json toJson(const Distribution& d) {
  return {{"count", d.count},         {"mean", d.mean},
          {"deviation", d.deviation}, {"percentile5", d.percentile5},
          {"quartile1", d.quartile1}, {"median", d.median},
          {"quartile3", d.quartile3}, {"percentile95", d.percentile95}};
}

ordered_json withInterval(double value, const Interval& interval) {
  return {{"value", value}, {"low", interval.low}, {"high", interval.high}};
}

/** A statistic of the whole sample, and its bootstrap interval. */
ordered_json estimated(std::size_t count, const Statistic& statistic) {
  std::vector<std::size_t> all(count);
  for (std::size_t i = 0; i < count; ++i) all[i] = i;
  return withInterval(count ? statistic(all) : 0, bootstrap(count, statistic));
}

ordered_json share(const std::vector<double>& zerosAndOnes) {
  return estimated(zerosAndOnes.size(),
                   [&](const auto& which) { return mean(pick(zerosAndOnes, which)); });
}

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

ordered_json timesJson(const Group& group) {
  ordered_json json;
  for (const auto& [name, stage] : stages()) json[name] = toJson(describe(sampleOf(group, stage)));
  return json;
}

ordered_json groupJson(const GroupKey& key, const Group& group) {
  std::vector<double> found;
  for (const auto& [instance, trial] : group) found.push_back(trial->found);
  const auto sized = [&](Measure m) { return mean(sampleOf(group, m)); };
  return {{"judgment", key.judgment},
          {"graph", key.graph},
          {"budget", key.budget},
          {"memory", memoryName(key.kept)},
          {"trials", group.size()},
          {"found", countFound(group)},
          {"success", share(found)},
          {"vertices", sized([](const Trial& t) { return static_cast<double>(t.vertices); })},
          {"edges", sized([](const Trial& t) { return static_cast<double>(t.edges); })},
          {"edgesEvaluated", toJson(describe(sampleOf(group, edgesEvaluated)))},
          {"milliseconds", timesJson(group)},
          {"metersOutsideBest", toJson(describe(sampleOf(group, metersOutsideBest)))},
          {"meters", toJson(describe(sampleOf(group, meters)))},
          {"weightedMeters", toJson(describe(sampleOf(group, weightedMeters)))}};
}

template <class Part>
ordered_json lexicographic(const Pairs& pairs, Part part) {
  std::size_t counts[3] = {0, 0, 0};
  std::vector<double> notWorse;
  for (const auto& [a, b] : pairs.all) {
    const int order = compareTrials(*a, *b, part);
    ++counts[order + 1];
    notWorse.push_back(order <= 0);
  }
  return {{"better", counts[0]},
          {"equal", counts[1]},
          {"worse", counts[2]},
          {"notWorse", share(notWorse)}};
}

ordered_json differenceJson(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> difference;
  for (std::size_t i = 0; i < a.size(); ++i) difference.push_back(a[i] - b[i]);
  return estimated(a.size(), [&](const auto& which) { return mean(pick(difference, which)); });
}

/** Compares two samples that belong together one by one. */
ordered_json comparison(const std::vector<double>& a, const std::vector<double>& b) {
  const auto ratioOf = [&](double (*statistic)(const std::vector<double>&)) {
    return estimated(a.size(), [&, statistic](const auto& which) {
      return ratio(statistic(pick(a, which)), statistic(pick(b, which)));
    });
  };
  return {{"difference", differenceJson(a, b)},
          {"ratioOfMeans", ratioOf(mean)},
          {"ratioOfDeviations", ratioOf(deviation)}};
}

ordered_json measureComparison(const Pairs& pairs, Measure measure) {
  std::vector<double> a, b;
  for (const auto& [first, second] : pairs.solved) {
    a.push_back(measure(*first));
    b.push_back(measure(*second));
  }
  return comparison(a, b);
}

ordered_json keyJson(const GroupKey& key) {
  return {{"judgment", key.judgment},
          {"graph", key.graph},
          {"budget", key.budget},
          {"memory", memoryName(key.kept)}};
}

ordered_json pairJson(const GroupKey& keyA, const Group& a, const GroupKey& keyB, const Group& b) {
  const Pairs pairs = pairsOf(a, b);
  ordered_json json = {{"a", keyJson(keyA)},
                       {"b", keyJson(keyB)},
                       {"pairs", pairs.all.size()},
                       {"solvedByBoth", pairs.solved.size()},
                       {"way", lexicographic(pairs, &Trial::way)}};
  if (keyA.judgment == keyB.judgment && keyA.judgment != kWeighted)
    json["cost"] = lexicographic(pairs, &Trial::cost);
  json["metersOutsideBest"] = measureComparison(pairs, metersOutsideBest);
  json["meters"] = measureComparison(pairs, meters);
  json["weightedMeters"] = measureComparison(pairs, weightedMeters);
  json["edgesEvaluated"] = measureComparison(pairs, edgesEvaluated);
  for (const auto& [name, stage] : stages())
    json["milliseconds"][name] = measureComparison(pairs, stage);
  return json;
}

bool isPeer(const GroupKey& key) { return key.graph.back() == '*'; }

/** Whether two groups of one graph differ in a judgment alone, or in remembering edges. */
bool differInOneThing(const GroupKey& a, const GroupKey& b) {
  if (a.kept || b.kept) return a.kept && !b.kept && a.judgment == b.judgment;
  return a.judgment != "profile" && b.judgment == "profile";
}

/** Which pairs of ways say something. */
bool areCompared(const GroupKey& a, const GroupKey& b, const std::string& firstGraph) {
  if (a.graph == kReference || isPeer(a)) return false;
  if (b.graph == kReference) return a.judgment == b.judgment && !a.kept;
  if (isPeer(b)) return a.graph == firstGraph && a.judgment == "profile" && !a.kept;
  if (a.budget != b.budget) return false;
  if (a.graph == b.graph) return differInOneThing(a, b);
  return a.graph == firstGraph && a.judgment == b.judgment && (a.kept || !b.kept);
}

ordered_json mapJson(const MapStudy& map, const std::string& firstGraph) {
  const Groups groups = groupsOf(map.trials);
  ordered_json ways = ordered_json::array(), pairs = ordered_json::array();
  for (const auto& [key, group] : groups) ways.push_back(groupJson(key, group));
  for (const auto& [keyA, a] : groups)
    for (const auto& [keyB, b] : groups)
      if (areCompared(keyA, keyB, firstGraph)) pairs.push_back(pairJson(keyA, a, keyB, b));
  return {{"name", map.name},
          {"file", map.file},
          {"instances", map.instances},
          {"ranks", map.ranks},
          {"knownLeaves", map.leaves},
          {"compressedKnownLeaves", map.compressedLeaves},
          {"milliseconds", {{"abstraction", map.abstractionTime}, {"ground", map.groundTime}}},
          {"ways", ways},
          {"pairs", pairs}};
}

ordered_json optionsJson(StudyOptions options) {
  std::vector<std::string> graphs;
  for (const auto kind : options.graphs) graphs.push_back(nameOf(kind));
  ordered_json json = {{"instances", options.instances},
                       {"seed", options.seed},
                       {"minDistance", options.minDistance},
                       {"budgets", options.budgets},
                       {"graphs", graphs},
                       {"edgesPerVertex", options.edgesPerVertex},
                       {"reference", options.reference},
                       {"peerSeconds", options.peerTimes},
                       {"peerInstances", options.peers ? options.peerInstances : 0}};
  json.update(jsonOf(sharedOptions(options.planner)));
  return json;
}

}  // namespace

ordered_json toJson(const std::vector<MapStudy>& maps, const StudyOptions& options) {
  ordered_json json = {
      {"units", "meters; processor milliseconds; intervals of 95 % by the bootstrap"},
      {"options", optionsJson(options)},
      {"maps", ordered_json::array()}};
  const std::string firstGraph = nameOf(options.graphs.front());
  for (const MapStudy& map : maps) json["maps"].push_back(mapJson(map, firstGraph));
  return json;
}

}  // namespace planning_study
