// The paper's planning experiment: the same random tasks for graphs of the compressed tree and for
// Halton graphs, with equal numbers of vertices and edges.
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/planner/SemanticPlanner.h>
#include <strict_files/TextFile.h>

#include <cmath>
#include <random>
#include <sstream>
#include <stdexcept>

#include "Application.h"
#include "inputs/Inputs.h"
#include "measuring/Measuring.h"

namespace planning_study {
namespace {

using colored_graph::EdgeModel;
using mrpt::math::TPose2D;
using semantic_octree::SemanticOcTree;
using namespace semantic_planning;

constexpr GraphKind kGraphs[] = {GraphKind::Leaves, GraphKind::Halton, GraphKind::HaltonDrivable};
constexpr EdgeModel kJudgments[] = {EdgeModel::Profile, EdgeModel::Endpoint};
constexpr std::size_t kEdgesPerVertex = 5;

struct Cli {
  std::filesystem::path map, order, weights, output;
  std::string solution;
  std::size_t instances = 50, vertices = 500;
  std::uint64_t seed = 1;
  double minDistance = 30;  // m
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    inputs::addMap(app, map);
    app.add_option("--order", order, "Classes from best to worst (YAML)")->required();
    app.add_option("--weights", weights, "What the compressed tree keeps (YAML)")->required();
    app.add_option("--solution", solution,
                   "Name of one solution in the weights; without: the first")
        ->type_name("NAME");
    outputs.add(app, output, "FILE", "Table of all searches (CSV)")->required();
    addNumber(app, "--instances", instances, strict_files::above(0), "Pairs of start and goal");
    addNumber(app, "--vertices", vertices, strict_files::above(0),
              "Vertices of each graph; of halton, points drawn, also off the ground");
    addNumber(app, "--min-distance", minDistance, strict_files::above(0), "From start to goal, m");
    app.add_option("--seed", seed, "Seed of the pairs")->capture_default_str();
  }
};

/** A task for all planners. Meters, radians; map frame. */
struct Instance {
  TPose2D start, goal;
};

constexpr int kMostTries = 100000;  // for one instance

class PoseDraw {
 public:
  PoseDraw(const SemanticPlanner& planner, std::uint64_t seed)
      : m_planner(planner), m_tiles(planner.ground().tiles()), m_random(seed) {
    if (m_tiles.empty()) throw std::runtime_error("the map has no ground");
  }

  /** Nothing if the draw did not hit a place to stand. */
  std::optional<TPose2D> pose() {
    const Ground& ground = m_planner.ground();
    const auto i = static_cast<std::size_t>(unit() * static_cast<double>(m_tiles.size()));
    const Column low = firstColumnOf(m_tiles[i]);
    const double edge = kTileEdge * ground.voxelSize(), half = ground.voxelSize() / 2;
    const double x = ground.centerOf(low.x) - half + unit() * edge;
    const double y = ground.centerOf(low.y) - half + unit() * edge;
    const TPose2D pose(x, y, (2 * unit() - 1) * M_PI);
    return m_planner.check(pose) == PlanStatus::Found ? std::optional(pose) : std::nullopt;
  }

 private:
  /** In [0, 1), the same with every standard library. */
  double unit() { return std::ldexp(static_cast<double>(m_random() >> 11), -53); }

  const SemanticPlanner& m_planner;
  const std::vector<Column> m_tiles;
  std::mt19937_64 m_random;
};

bool isConnected(const Ground& ground, const Instance& instance) {
  const auto a = ground.find(instance.start.x, instance.start.y);
  const auto b = ground.find(instance.goal.x, instance.goal.y);
  return a && b && ground.connected(*a, *b);
}

Instance drawInstance(const Ground& ground, PoseDraw& draw, double minDistance) {
  for (int i = 0; i < kMostTries; ++i) {
    const auto start = draw.pose(), goal = draw.pose();
    if (!start || !goal) continue;
    const Instance instance{*start, *goal};
    if (std::hypot(goal->x - start->x, goal->y - start->y) >= minDistance &&
        isConnected(ground, instance))
      return instance;
  }
  throw std::runtime_error("no start and goal on connected ground, " + std::to_string(minDistance) +
                           " m apart, found in " + std::to_string(kMostTries) + " draws");
}

/** Pairs of poses, drawn evenly over the ground where the vehicle can stand, with any heading; each
 * pair is connected by ground. They depend on the ground, the count and the seed alone: not on any
 * graph. The first n of more are those of n. \throw std::runtime_error hardly any such pair is
 * found. */
std::vector<Instance> drawInstances(const SemanticPlanner& planner, const Cli& cli) {
  PoseDraw draw(planner, cli.seed);
  std::vector<Instance> instances;
  while (instances.size() < cli.instances)
    instances.push_back(drawInstance(planner.ground(), draw, cli.minDistance));
  return instances;
}

PlannerOptions optionsOf(const Cli& cli, GraphKind kind, EdgeModel judgment) {
  PlannerOptions options;
  options.roadmap.kind = kind;
  options.roadmap.vertices = cli.vertices;
  options.roadmap.maxEdges = kEdgesPerVertex * cli.vertices;
  options.cost = colored_graph::CostKind::Count;  // as in the paper
  options.edges = judgment;
  options.vehicle.reverseWeight = 1;  // direction costs nothing, as in the paper
  options.vehicle.gearChange = options.vehicle.steeringChange = 0;
  return options;
}

/** Meters of a path that are not in the best rank. */
double offTheBest(const PlanResult& plan, const colored_graph::ClassOrder& order) {
  double meters = 0;
  for (std::size_t id = 0; id < plan.lengthPerClass.size(); ++id)
    if (order.rank(static_cast<colored_graph::GraphClass>(id)) > 0)
      meters += plan.lengthPerClass[id];
  return meters;
}

double milliseconds(const PlanResult& plan, const std::string& name) {
  double sum = 0;
  for (const auto& [stage, time] : plan.times)
    if (stage == name) sum += time;
  return sum;
}

/** Plans a task as the first one. What else runs on the machine does not count: times are of the
 * processor, shared out as the clock on the wall says. */
void writeRow(std::ostream& out, std::size_t number, const Instance& task,
              SemanticPlanner& planner) {
  planner.forget();
  const measuring::Stopwatch processor(measuring::TimeOf::Process), wall;
  const PlanResult plan = planner.plan(task.start, task.goal);
  const double share = processor.milliseconds() / wall.milliseconds();
  out << number << ',' << (planner.options().edges == EdgeModel::Profile ? "profile" : "endpoint")
      << ',' << nameOf(planner.options().roadmap.kind) << ',' << plan.found() << ','
      << plan.numVertices << ',' << plan.numEdges << ',' << plan.search.edgesEvaluated << ','
      << offTheBest(plan, planner.order()) << ',' << plan.length << ','
      << share * milliseconds(plan, "evaluateEdges") << ',' << share * milliseconds(plan, "search")
      << '\n';
}

std::vector<SemanticPlanner> plannersOf(const Cli& cli, SemanticOcTree& map,
                                        const colored_graph::ClassOrder& order) {
  std::vector<SemanticPlanner> planners;
  for (const GraphKind kind : kGraphs)
    for (const EdgeModel judgment : kJudgments)
      planners.emplace_back(map, order, optionsOf(cli, kind, judgment));
  return planners;
}

int run(const Cli& cli) {
  const StopRequest stop("after this instance");
  cli.outputs.check({cli.output});
  SemanticOcTree map = inputs::loadMap(cli.map);
  const auto order = loadClassOrder(cli.order, map.classes());
  setAbstraction(map, semantic_octree::loadSolution(cli.weights, cli.solution, map.classes()));
  std::vector<SemanticPlanner> planners = plannersOf(cli, map, order);
  const auto instances = drawInstances(planners[0], cli);
  std::ostringstream csv;
  csv << "instance,judgment,graph,found,vertices,edges,edges evaluated,off the best [m],"
         "length [m],evaluation [ms],search [ms]\n";
  for (std::size_t i = 0; i < instances.size() && !stop.pending(); ++i)
    for (SemanticPlanner& planner : planners) writeRow(csv, i, instances[i], planner);
  strict_files::writeText(cli.output, csv.str());
  return 0;
}

}  // namespace
}  // namespace planning_study

int main(int argc, char** argv) {
  CLI::App app("Plans random tasks with the published graphs: the paper's planning experiment");
  planning_study::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return planning_study::run(cli); });
}
