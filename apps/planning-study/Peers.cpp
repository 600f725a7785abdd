#include "Peers.h"

#include <ompl/base/PlannerData.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/prm/LazyPRMstar.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/util/Console.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "OmplProblem.h"
#include "RoadmapSearch.h"
#include "measuring/Stopwatch.h"

namespace planning_study {

namespace og = ompl::geometric;
using measuring::Stopwatch;
using ompl::base::PlannerTerminationCondition;

namespace {

/** Whether it has a path by now. */
using HasPath = std::function<bool()>;

HasPath hasPathOf(const ompl::base::Planner& planner) {
  for (const auto& [name, cost] : planner.getPlannerProgressProperties())
    if (name.rfind("best cost", 0) == 0)  // "inf" or "nan" before
      return [cost = cost] { return std::isfinite(std::stod(cost())); };
  throw std::logic_error(planner.getName() + " does not tell its costs");
}

void countGraph(const ompl::base::Planner& planner, Trial& trial) {
  ompl::base::PlannerData data(planner.getSpaceInformation());
  planner.getPlannerData(data);
  trial.vertices = data.numVertices();
  trial.edges = data.numEdges();
}

/** PRM* asks from two threads whether time is over. */
ompl::base::PlannerStatus solve(ompl::base::Planner& peer, double seconds, Trial& trial) {
  const HasPath hasPath = hasPathOf(peer);
  const Stopwatch watch(measuring::TimeOf::Process);
  std::atomic<double> first{0};
  const auto status = peer.solve(PlannerTerminationCondition([&] {
    const double passed = watch.milliseconds();
    if (first == 0 && hasPath()) first = passed;
    return passed >= 1e3 * seconds;
  }));
  trial.searchTime = watch.milliseconds();
  trial.firstPathTime = first == 0 ? trial.searchTime : first.load();
  return status;
}

template <class OmplPlanner>
Trial run(const semantic_planning::SemanticPlanner& planner, const Instance& instance,
          double seconds) {
  const OmplProblem problem(planner, instance);
  OmplPlanner peer(problem.space);
  peer.setProblemDefinition(problem.definition);
  peer.setup();
  Trial trial;
  const auto status = solve(peer, seconds, trial);
  trial.judgment = kWeighted;
  trial.budget = static_cast<std::size_t>(std::lround(1e3 * seconds));
  trial.task = instance;
  trial.status = status.asString();
  trial.found = status == ompl::base::PlannerStatus::EXACT_SOLUTION;
  trial.evaluated = problem.motionsChecked();
  countGraph(peer, trial);
  if (trial.found) trial.way = wayOf(problem.lengthPerClass(), planner.order());
  return trial;
}

using Run = decltype(&run<og::PRMstar>);

const std::vector<std::pair<std::string, Run>>& peers() {
  static const std::vector<std::pair<std::string, Run>> peers = {
      {"prm*", run<og::PRMstar>}, {"lazy-prm*", run<og::LazyPRMstar>}, {"bit*", run<og::BITstar>}};
  return peers;
}

}  // namespace

const std::vector<std::string>& peerNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, run] : peers()) all.push_back(name);
    return all;
  }();
  return names;
}

Trial runPeer(const std::string& name, const semantic_planning::SemanticPlanner& planner,
              const Instance& instance, double seconds) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  for (const auto& [peer, run] : peers()) {
    if (peer != name) continue;
    Trial trial = run(planner, instance, seconds);
    trial.graph = name;
    return trial;
  }
  throw std::invalid_argument("no peer is called " + name);
}

}  // namespace planning_study
