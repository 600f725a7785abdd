#include "Peers.h"

#include <ompl/base/PlannerData.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/prm/LazyPRMstar.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <cmath>

#include "CpuClock.h"
#include "OmplProblem.h"
#include "RoadmapTrials.h"

namespace planning_study {

namespace og = ompl::geometric;
using ompl::base::PlannerTerminationCondition;

namespace {

void countGraph(const ompl::base::Planner& planner, Trial& trial) {
  ompl::base::PlannerData data(planner.getSpaceInformation());
  planner.getPlannerData(data);
  trial.vertices = data.numVertices();
  trial.edges = data.numEdges();
}

template <class OmplPlanner>
Trial runPeer(const char* name, const semantic_planning::SemanticPlanner& planner,
              const Instance& instance, double seconds) {
  const OmplProblem problem(planner, instance);
  OmplPlanner peer(problem.space);
  peer.setProblemDefinition(problem.definition);
  peer.setup();
  const double begin = cpuMilliseconds(), end = begin + 1e3 * seconds;
  const auto solved =
      peer.solve(PlannerTerminationCondition([end] { return cpuMilliseconds() >= end; }));
  Trial trial;
  trial.searchTime = cpuMilliseconds() - begin;
  trial.judgment = kWeighted;
  trial.graph = name;
  trial.budget = static_cast<std::size_t>(std::lround(1e3 * seconds));
  trial.task = instance;
  trial.status = solved.asString();
  trial.found = solved == ompl::base::PlannerStatus::EXACT_SOLUTION;
  trial.evaluated = problem.motionsChecked();
  countGraph(peer, trial);
  if (trial.found) trial.way = wayOf(problem.lengthPerClass(), planner.order());
  return trial;
}

}  // namespace

std::vector<Trial> runPeers(const semantic_planning::SemanticPlanner& planner,
                            const Instance& instance, double seconds) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  return {runPeer<og::PRMstar>("prm*", planner, instance, seconds),
          runPeer<og::LazyPRMstar>("lazy-prm*", planner, instance, seconds),
          runPeer<og::BITstar>("bit*", planner, instance, seconds)};
}

}  // namespace planning_study
