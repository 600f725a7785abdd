#include "RoadmapTrials.h"

#include <colored_graph/CostModel.h>

#include <cmath>
#include <stdexcept>

#include "RoadmapSearch.h"
#include "measuring/Stopwatch.h"

namespace planning_study {

using colored_graph::EdgeModel;
using colored_graph::VertexId;
using mrpt::math::TPose2D;
using namespace semantic_planning;

/** Sees, as the one who may cancel it, when the planner begins to search. */
class RoadmapTrials::SearchWatch {
 public:
  void expect(bool cancelSearch) {
    m_cancel = cancelSearch;
    m_begun.reset();
    m_watch.lap();
  }
  bool isCancelled() {
    if (!m_begun) m_begun = m_watch.milliseconds();
    return m_cancel;
  }
  /** Processor milliseconds from expect() to the search, and from there until now. */
  double beforeSearch() const { return m_begun.value_or(0); }
  double sinceSearch() const { return m_watch.milliseconds() - beforeSearch(); }

 private:
  bool m_cancel = false;
  measuring::Stopwatch m_watch{measuring::TimeOf::Process};
  std::optional<double> m_begun;
};

namespace {

template <class Watch>
PlannerOptions watched(PlannerOptions options, Watch& watch) {
  options.cancelled = [&watch] { return watch.isCancelled(); };
  return options;
}

VertexId vertexAt(const Roadmap& roadmap, const TPose2D& pose) {
  for (VertexId v = roadmap.graph().vertexIdEnd(); v-- > 0;)  // start and goal come last
    if (roadmap.graph().containsVertex(v) && roadmap.pose(v).pose == pose) return v;
  throw std::logic_error("the graph has no vertex at the start or at the goal");
}

double stage(const PlanResult& plan, const std::string& name) {
  double sum = 0;
  for (const auto& [stage, milliseconds] : plan.times)
    if (stage == name) sum += milliseconds;
  return sum;
}

/** \param sinceSearchBegan processor milliseconds, shared out as the clock on the wall says */
void splitTime(double sinceSearchBegan, const PlanResult& plan, Trial& trial) {
  const double search = stage(plan, "search"), evaluation = stage(plan, "evaluateEdges");
  const double scale = sinceSearchBegan / (search + evaluation + stage(plan, "path"));
  trial.searchTime = scale * search;
  trial.evaluationTime = scale * evaluation;
}

std::vector<Length> inUnits(const std::vector<double>& meters) {
  std::vector<Length> lengths;
  for (const double m : meters) lengths.push_back(std::llround(m / colored_graph::toMeters(1)));
  return lengths;
}

}  // namespace

RoadmapTrials::RoadmapTrials(semantic_octree::SemanticOcTree& map,
                             const colored_graph::ClassOrder& order, PlannerOptions options,
                             bool kept)
    : m_watch(std::make_unique<SearchWatch>()),
      m_planner(map, order, watched(std::move(options), *m_watch)),
      m_kept(kept) {}

RoadmapTrials::~RoadmapTrials() = default;
RoadmapTrials::RoadmapTrials(RoadmapTrials&&) noexcept = default;

Trial RoadmapTrials::trialOf(const Instance& instance, const PlanResult& plan) const {
  if (!m_planner.hasRoadmap()) throw std::logic_error("the planner refused: " + plan.reason);
  Trial trial;
  trial.graphTime = m_watch->beforeSearch();
  trial.judgment = nameOf(EdgeModel::Profile);
  trial.graph = nameOf(m_planner.options().roadmap.kind);
  trial.budget = m_planner.options().roadmap.vertices;
  trial.task = instance;
  trial.kept = m_kept;
  trial.vertices = plan.numVertices;
  trial.edges = plan.numEdges;
  return trial;
}

Trial RoadmapTrials::plan(const Instance& instance) {
  if (!m_kept) m_planner.forget();
  m_watch->expect(false);
  const PlanResult plan = m_planner.plan(instance.start, instance.goal);
  const double sinceSearchBegan = m_watch->sinceSearch();
  Trial trial = trialOf(instance, plan);
  splitTime(sinceSearchBegan, plan, trial);
  trial.found = plan.found();
  trial.status = nameOf(plan.status);
  trial.evaluated = plan.search.edgesEvaluated;
  trial.expansions = plan.search.expansions;
  trial.cost = plan.cost;
  if (trial.found) trial.way = wayOf(inUnits(plan.lengthPerClass), m_planner.order());
  return trial;
}

std::vector<Trial> RoadmapTrials::judge(const Instance& instance) {
  if (!m_kept) m_planner.forget();
  m_watch->expect(true);
  const PlanResult made = m_planner.plan(instance.start, instance.goal);
  std::vector<Trial> trials(3, trialOf(instance, made));
  const Roadmap& roadmap = m_planner.roadmap();
  const RoadmapTask task{roadmap, vertexAt(roadmap, instance.start),
                         vertexAt(roadmap, instance.goal), m_planner.order(),
                         m_planner.options().cost};
  searchColored(task, EdgeModel::Endpoint, trials[0]);
  searchColored(task, EdgeModel::Sweep, trials[1]);
  searchWeighted(task, trials[2]);
  return trials;
}

}  // namespace planning_study
