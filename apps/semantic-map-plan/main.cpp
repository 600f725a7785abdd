// Plans a path of a vehicle over a semantic map, classes before length.
#include <map_pictures/MapPictures.h>
#include <semantic_octree/MapFolder.h>
#include <semantic_planning/planner/OrderAbstraction.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/vehicle/VehicleFile.h>
#include <strict_files/OutputFolder.h>
#include <strict_files/TextFile.h>

#include <iostream>

#include "Application.h"
#include "Cli.h"
#include "JsonFile.h"
#include "PlanFiles.h"
#include "PlanPicture.h"
#include "PlanScene.h"
#include "StandardOutput.h"
#include "measuring/Stopwatch.h"

namespace semantic_map_plan {
namespace {

namespace fs = std::filesystem;
using namespace semantic_planning;
using semantic_octree::AbstractionOptions;
using semantic_octree::SemanticOcTree;

constexpr int kNoPath = 2;  // exit status
const std::vector<std::string> kFiles = {"path.json", "path.csv", "plan.png", "plan.3Dscene",
                                         "roadmap.graph"};

/** All results; of a plan that failed all but the path itself. */
void write(const Cli& cli, const SemanticOcTree& map, const SemanticPlanner& planner,
           const PlanResult& plan, const nlohmann::json& report) {
  strict_files::OutputFolder output(cli.output);
  writeJson(output.staged("path.json"), report);
  if (plan.found()) strict_files::writeText(output.staged("path.csv"), toCsv(plan, map.classes()));
  map_pictures::savePicture(drawPlan(map, planner, plan, cli.start, cli.goal),
                            output.staged("plan.png"));
  saveScene(map.isReadOnly() ? nullptr : &map, planner, plan, output.staged("plan.3Dscene"));
  if (planner.hasRoadmap())
    saveNetwork(planner.roadmap(), map.classes(), output.staged("roadmap.graph"));
  output.commit(kFiles);
}

void printSummary(const PlanResult& plan, const semantic_types::ClassTable& classes) {
  notes() << "Path of " << plan.length << " m:";
  for (std::size_t id = 0; id < plan.lengthPerClass.size(); ++id)
    if (plan.lengthPerClass[id] > 0)
      notes() << ' ' << plan.lengthPerClass[id] << " m "
              << groundName(static_cast<semantic_types::ClassId>(id), classes);
  notes() << "\nGraph of " << plan.numVertices << " vertices and " << plan.numEdges << " edges, "
          << plan.search.edgesEvaluated << " of them evaluated\n";
}

int run(Cli& cli) {
  cli.outputs.checkFolder(cli.output, kFiles);
  semantic_octree::StoredMap stored(cli.map, cli.memory);
  SemanticOcTree& map = stored.tree();
  const auto order = loadClassOrder(cli.classes, map.classes());
  if (!cli.vehicle.empty()) cli.planner.vehicle = loadVehicle(cli.vehicle);
  measuring::Stopwatch watch;
  if (isOfTree(cli.planner.roadmap.kind))
    map.setAbstraction(cli.weights.empty()
                           ? abstractionFor(order)
                           : abstractionOf(cli.weights, cli.solution, map.classes()));
  const double abstraction = watch.lap();
  SemanticPlanner planner(map, order, cli.planner);
  const double ground = watch.lap();
  const PlanResult plan = planner.plan(cli.start, cli.goal, cli.startZ, cli.goalZ);
  nlohmann::json report = toJson(plan, order, map.classes());
  report["milliseconds"]["abstraction"] = abstraction;
  report["milliseconds"]["ground"] = ground;
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
  semantic_map_plan::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_plan::run(cli); });
}
