#include "RoadmapTrials.h"

#include <stdexcept>

#include "CpuClock.h"
#include "RoadmapSearch.h"

namespace planning_study {

using colored_graph::EdgeModel;
using colored_graph::VertexId;
using mrpt::math::TPose2D;
using namespace semantic_planning;

const char* const kWeighted = "weighted";

const char* nameOf(EdgeModel model) {
  const char* names[] = {"endpoint", "sweep", "profile"};
  return names[static_cast<int>(model)];
}

namespace {

/** The planner shall make its graph, but not search it. */
PlannerOptions withoutSearch(PlannerOptions options) {
  options.cancelled = [] { return true; };
  return options;
}

VertexId vertexAt(const Roadmap& roadmap, const TPose2D& pose) {
  for (VertexId v = roadmap.graph().vertexIdEnd(); v-- > 0;)  // start and goal come last
    if (roadmap.graph().containsVertex(v) && roadmap.pose(v).pose == pose) return v;
  throw std::logic_error("the graph has no vertex at the start or at the goal");
}

void search(const RoadmapTask& task, const std::string& judgment, Trial& trial) {
  trial.judgment = judgment;
  if (judgment == kWeighted) return searchWeighted(task, trial);
  for (const EdgeModel model : {EdgeModel::Endpoint, EdgeModel::Sweep, EdgeModel::Profile})
    if (judgment == nameOf(model)) return searchColored(task, model, trial);
  throw std::logic_error("no judgment is called " + judgment);
}

}  // namespace

RoadmapTrials::RoadmapTrials(semantic_octree::SemanticOcTree& map,
                             const colored_graph::ClassOrder& order, PlannerOptions options,
                             bool kept)
    : m_planner(map, order, withoutSearch(std::move(options))), m_kept(kept) {}

std::vector<Trial> RoadmapTrials::run(const Instance& instance,
                                      const std::vector<std::string>& judgments) {
  const double begin = cpuMilliseconds();
  const PlanResult made = m_planner.plan(instance.start, instance.goal);
  Trial common;
  common.graphTime = cpuMilliseconds() - begin;
  if (!m_planner.hasRoadmap()) throw std::logic_error("the planner refused: " + made.reason);
  const Roadmap& roadmap = m_planner.roadmap();
  common.graph = nameOf(m_planner.options().roadmap.kind);
  common.budget = m_planner.options().roadmap.vertices;
  common.task = instance;
  common.kept = m_kept;
  common.vertices = roadmap.graph().vertexCount();
  common.edges = roadmap.graph().edgeCount();
  const RoadmapTask task{roadmap, vertexAt(roadmap, instance.start),
                         vertexAt(roadmap, instance.goal), m_planner.order()};
  std::vector<Trial> trials(judgments.size(), common);
  for (std::size_t i = 0; i < judgments.size(); ++i) search(task, judgments[i], trials[i]);
  return trials;
}

}  // namespace planning_study
