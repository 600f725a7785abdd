#include "Study.h"

#include <map_folders/MapFolder.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/planner/OrderFile.h>

#include <sstream>
#include <stdexcept>

#include "Peers.h"
#include "RoadmapTrials.h"
#include "measuring/Stopwatch.h"

namespace planning_study {

using semantic_octree::SemanticOcTree;
using namespace semantic_planning;

const char* const kReference = "reference";

strict_files::OptionList sharedOptions(PlannerOptions& planner) {
  strict_files::OptionList options;
  planner.describe(options);
  for (const char* studied :
       {"graph", "vertices", "edges", "reading", "least_probability", "shorten", "time_limit"})
    options.remove(studied);
  return options;
}

namespace {

constexpr unsigned kReferenceSeed = 1;  // no vertices of the graphs that are compared with it

template <class Value>
void refuse(const char* field, const Value& value, const char* expected) {
  std::ostringstream message;
  message << "StudyOptions: " << field << " is " << value << ", expected " << expected;
  throw std::invalid_argument(message.str());
}

PlannerOptions withGraph(const StudyOptions& study, GraphKind kind, std::size_t budget) {
  PlannerOptions options = study.planner;
  options.roadmap.kind = kind;
  options.roadmap.vertices = budget;
  options.roadmap.maxEdges =
      static_cast<std::size_t>(study.edgesPerVertex * static_cast<double>(budget));
  return options;
}

void append(std::vector<Trial> more, std::vector<Trial>& trials) {
  std::move(more.begin(), more.end(), std::back_inserter(trials));
}

void measurePreparation(SemanticOcTree& map, const colored_graph::ClassOrder& order,
                        const StudyOptions& options, MapStudy& study) {
  measuring::Stopwatch watch(measuring::TimeOf::Process);
  setAbstraction(map, options.weights.empty()
                          ? abstractionFor(order)
                          : abstractionOf(options.weights, options.solution, map.classes()));
  study.abstractionTime = watch.lap();
  const Ground ground(map, options.planner.vehicle, options.planner.ground, order);
  study.groundTime = watch.lap();
  const auto measures = semantic_octree::Abstraction(map).measures();
  study.leaves = measures.full.numKnownLeaves;
  study.compressedLeaves = measures.compressed.numKnownLeaves;
}

}  // namespace

void StudyOptions::validate() const {
  if (instances == 0) refuse("instances", instances, "at least 1");
  if (!(minDistance > 0)) refuse("minDistance", minDistance, "a positive number");
  if (graphs.empty()) refuse("graphs", "empty", "at least one");
  if (budgets.empty()) refuse("budgets", "empty", "at least one");
  for (const std::size_t budget : budgets)
    if (budget == 0) refuse("budgets", budget, "positive numbers");
  if (!(edgesPerVertex > 0)) refuse("edgesPerVertex", edgesPerVertex, "a positive number");
  if (!(minutes > 0)) refuse("minutes", minutes, "a positive number");
  for (const double time : peerTimes)
    if (!(time > 0)) refuse("peerTimes", time, "positive numbers");
}

/** All planners of a map, which take turns at every instance. */
class StudyRunner::Contest {
 public:
  Contest(const std::string& file, const std::string& classesFile, const StudyOptions& options)
      : m_options(options),
        m_map(semantic_octree::loadMap(file)),
        m_order(loadClassOrder(classesFile, m_map.classes())) {
    study.ranks = m_order.ranks();
    measurePreparation(m_map, m_order, options, study);
    for (const std::size_t budget : options.budgets)
      for (const GraphKind kind : options.graphs)
        for (const bool kept : {false, true})
          m_runners.emplace_back(m_map, m_order, withGraph(options, kind, budget), kept);
    if (options.reference > 0) prepareReference();
    const CollisionChecker checker(anyPlanner().ground(), options.planner.vehicle, m_order,
                                   options.planner.reading);
    m_instances = drawInstances(checker, options.instances, options.minDistance, options.seed);
  }

  void runNextInstance() {
    const std::size_t i = study.instances++;
    for (Trial& trial : run(i)) {
      trial.map = study.name;
      trial.instance = i;
      study.trials.push_back(std::move(trial));
    }
  }

  MapStudy study;

 private:
  void prepareReference() {
    auto dense = withGraph(m_options, GraphKind::HaltonDrivable, m_options.reference);
    dense.roadmap.seed = kReferenceSeed;
    dense.roadmap.maxEdges = 0;
    m_reference.emplace(m_map, m_order, dense, false);
  }

  std::vector<Trial> run(std::size_t i) {
    std::vector<Trial> trials;
    for (RoadmapTrials& runner : m_runners) {
      trials.push_back(runner.plan(m_instances[i]));
      if (!runner.kept()) append(runner.judge(m_instances[i]), trials);
    }
    if (m_reference) {
      trials.push_back(m_reference->plan(m_instances[i]));
      trials.back().graph = kReference;
    }
    if (m_options.peers && i < m_options.peerInstances) append(runPeers(m_instances[i]), trials);
    return trials;
  }

  std::vector<Trial> runPeers(const Instance& instance) const {
    std::vector<Trial> trials;
    for (const double seconds : m_options.peerTimes)
      for (const std::string& peer : peerNames())
        trials.push_back(runPeer(peer, anyPlanner(), instance, seconds));
    return trials;
  }

  const SemanticPlanner& anyPlanner() const { return m_runners.front().planner(); }

  const StudyOptions& m_options;
  SemanticOcTree m_map;
  const colored_graph::ClassOrder m_order;
  std::vector<RoadmapTrials> m_runners;
  std::optional<RoadmapTrials> m_reference;
  std::vector<Instance> m_instances;
};

StudyRunner::StudyRunner(const std::string& name, const std::string& file,
                         const std::string& classesFile, const StudyOptions& options)
    : m_contest(std::make_unique<Contest>(file, classesFile, options)) {
  m_contest->study.name = name;
  m_contest->study.file = file;
}
StudyRunner::~StudyRunner() = default;
StudyRunner::StudyRunner(StudyRunner&&) noexcept = default;

void StudyRunner::runNextInstance() { m_contest->runNextInstance(); }
const MapStudy& StudyRunner::study() const { return m_contest->study; }

}  // namespace planning_study
