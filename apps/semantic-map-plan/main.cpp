// Plans a path of a vehicle over a semantic map, classes before length.
#include <map_pictures/MapPictures.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_planning/planner/OrderAbstraction.h>
#include <semantic_planning/planner/OrderFile.h>
#include <strict_files/OutputFolder.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>

#include "../semantic-map-compress/WeightsFile.h"
#include "Application.h"
#include "Cli.h"
#include "PlanFiles.h"
#include "PlanPicture.h"
#include "PlanScene.h"

namespace semantic_map_plan {
namespace {

namespace fs = std::filesystem;
using namespace semantic_planning;
using semantic_octree::AbstractionOptions;
using semantic_octree::SemanticOcTree;

using Clock = std::chrono::steady_clock;

constexpr int kNoPath = 2;  // exit status

double milliseconds(Clock::duration d) {
  return std::chrono::duration<double, std::milli>(d).count();
}

AbstractionOptions abstractionOf(const Cli& cli, const SemanticOcTree& map,
                                 const colored_graph::ClassOrder& order) {
  if (cli.weights.empty()) return abstractionFor(order);
  const auto file = semantic_map_compress::loadWeights(cli.weights, map.classes());
  const auto named = [&](const auto& s) { return cli.solution.empty() || s.name == cli.solution; };
  const auto found = std::find_if(file.solutions.begin(), file.solutions.end(), named);
  if (found == file.solutions.end())
    throw std::runtime_error(cli.weights.string() + ": has no solution '" + cli.solution + "'");
  AbstractionOptions options = file.space;
  options.weights.terms = found->terms;
  options.weights.alpha = found->alpha.value_or(abstractionFor(order).weights.alpha);
  return options;
}

void writeText(const std::string& text, const fs::path& file) {
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

/** All results; of a plan that failed all but the path itself. */
void write(const Cli& cli, const SemanticOcTree& map, const SemanticPlanner& planner,
           const PlanResult& plan, const nlohmann::json& report) {
  strict_files::OutputFolder output(cli.output);
  writeText(report.dump(2) + "\n", output.staged("path.json"));
  if (plan.found()) writeText(toCsv(plan, map.classes()), output.staged("path.csv"));
  map_pictures::savePicture(drawPlan(map, planner, plan, cli.start, cli.goal),
                            output.staged("plan.png"));
  saveScene(map, planner, plan, output.staged("plan.3Dscene"));
  output.commit({"path.json", "path.csv", "plan.png", "plan.3Dscene"});
}

void printSummary(const PlanResult& plan, const semantic_types::ClassTable& classes) {
  std::cout << "Path of " << plan.length << " m:";
  for (std::size_t id = 0; id < plan.lengthPerClass.size(); ++id)
    if (plan.lengthPerClass[id] > 0)
      std::cout << ' ' << plan.lengthPerClass[id] << " m "
                << groundName(static_cast<semantic_types::ClassId>(id), classes);
  std::cout << "\nGraph of " << plan.numVertices << " vertices and " << plan.numEdges << " edges, "
            << plan.search.edgesEvaluated << " of them evaluated\n";
}

int run(Cli cli) {
  SemanticOcTree map = semantic_octree::loadTree(cli.map.string());
  const auto order = loadClassOrder(cli.classes, map.classes());
  if (!cli.vehicle.empty()) cli.planner.vehicle = loadVehicle(cli.vehicle);
  const auto begin = Clock::now();
  if (cli.planner.roadmap.kind == GraphKind::Compressed)
    map.setAbstraction(abstractionOf(cli, map, order));
  const auto abstracted = Clock::now();
  SemanticPlanner planner(map, order, cli.planner);
  const auto grounded = Clock::now();
  const PlanResult plan = planner.plan(cli.start, cli.goal, cli.startZ, cli.goalZ);
  nlohmann::json report = toJson(plan, order, map.classes());
  report["milliseconds"]["abstraction"] = milliseconds(abstracted - begin);
  report["milliseconds"]["ground"] = milliseconds(grounded - abstracted);
  write(cli, map, planner, plan, report);
  if (plan.found()) {
    printSummary(plan, map.classes());
    return 0;
  }
  std::cerr << "semantic-map-plan: no path: " << plan.reason << std::endl;
  return kNoPath;
}

}  // namespace
}  // namespace semantic_map_plan

int main(int argc, char** argv) {
  CLI::App app("Plans a path of a vehicle over a semantic map that puts classes before length");
  semantic_map_plan::Cli cli;
  cli.addTo(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_plan::run(cli); });
}
