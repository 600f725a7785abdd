// Plans a path of a vehicle over a semantic map, classes before length.
#include <map_folders/MapFolder.h>
#include <map_pictures/MapCanvas.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/planner/SemanticPlanner.h>
#include <semantic_planning/vehicle/VehicleOptions.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>
#include <CLI/CLI.hpp>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "Application.h"
#include "PlanFiles.h"
#include "inputs/Inputs.h"
#include "measuring/Measuring.h"
#include "poses/Poses.h"

namespace semantic_map_plan {
namespace {

using namespace semantic_planning;
using inputs::TileProgress;
using map_pictures::MapCanvas;
using semantic_octree::SemanticOcTree;
using semantic_octree::StoredMap;

/** What the command line says. */
struct Cli {
  std::filesystem::path map, order, vehicle, weights, output;
  double memory = semantic_octree::MapFolderOptions().memory;
  std::string solution;
  mrpt::math::TPose2D start, goal;
  std::optional<double> startZ, goalZ;
  std::optional<double> corridor;  ///< of tiles, meters to each side; none: said nothing
  /** All but the vehicle. */
  semantic_planning::PlannerOptions planner;
  Outputs outputs;

  explicit Cli(CLI::App& app);
};

Cli::Cli(CLI::App& app) : outputs(app) {
  inputs::addMap(app, map);
  addMemoryOption(app, memory);
  poses::addPose(app, "--start", start, "Pose of the vehicle, m and degrees")->required();
  poses::addPose(app, "--goal", goal, "Pose to reach")->required();
  app.add_option("--start-z", startZ,
                 "Height of the start, where the ground has several levels, m");
  app.add_option("--goal-z", goalZ, "Height of the goal, m");
  app.add_option("--order", order, "Classes from best to worst (YAML)")->required();
  app.add_option("--vehicle", vehicle, "The vehicle (YAML); without: a small robot");
  app.add_option("--weights", weights,
                 "Weights of classes for the compressed tree (YAML, as for semantic-map-compress); "
                 "without: from --order");
  app.add_option("--solution", solution, "Solution in the weights; without: the first")
      ->type_name("NAME")
      ->needs("--weights");
  app.add_option("--corridor", corridor,
                 "Of a folder of tiles, read those within this distance of the line from start to "
                 "goal, m; without: half of its length, at least 100")
      ->check(isNumber(strict_files::above(0).orInfinite()));
  outputs.add(app, output, "FOLDER", "Folder of the results, created if need be")->required();
  planner.shorten = true;
  addOptions(app, strict_files::OptionList::of(planner), "Planner");
}

constexpr int kNoPath = 2;  // exit status
const std::vector<std::string> kFiles = {"path.json", "path.csv", "plan.png", "plan.3Dscene",
                                         "roadmap.graph"};

/** All results; of a plan that failed all but the path itself.
 * \param canvas with the map, and nothing on it yet */
void write(const Cli& cli, MapCanvas canvas, const SemanticPlanner& planner, const PlanResult& plan,
           const nlohmann::json& report) {
  const SemanticOcTree& map = planner.ground().map();
  strict_files::OutputFolder output(cli.output);
  writeJson(output.staged("path.json"), report);
  if (plan.found()) strict_files::writeText(output.staged("path.csv"), toCsv(plan, map.classes()));
  map_pictures::savePicture(drawPlan(std::move(canvas), planner, plan, cli.start, cli.goal),
                            output.staged("plan.png"));
  saveScene(map.isReadOnly() ? nullptr : &map, plan, output.staged("plan.3Dscene"));
  if (planner.hasRoadmap())
    saveNetwork(planner.roadmap(), map.classes(), output.staged("roadmap.graph"));
  output.commit(kFiles);
}

void printSummary(const PlanResult& plan, const semantic_types::ClassTable& classes) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "Path of " << plan.length << " m";
  const char* before = ": ";
  for (std::size_t id = 0; id < plan.lengthPerClass.size(); ++id)
    if (plan.lengthPerClass[id] > 0)
      text << std::exchange(before, ", ") << plan.lengthPerClass[id] << " m "
           << groundName(static_cast<semantic_types::ClassId>(id), classes);
  notes() << text.str() << '\n';
  if (plan.numVertices > 0)
    notes() << "Graph of " << plan.numVertices << " vertices and " << plan.numEdges << " edges, "
            << plan.search.edgesEvaluated << " of them evaluated\n";
}

/** Whether a tile of a folder's map is near the line from start to goal. */
bool isWanted(const Cli& cli, const Eigen::AlignedBox3d& cube) {
  const Eigen::Vector2d start(cli.start.x, cli.start.y),
      way(cli.goal.x - cli.start.x, cli.goal.y - cli.start.y);
  const double width = cli.corridor.value_or(std::max(100.0, way.norm() / 2));
  const Eigen::Vector2d center = cube.center().head<2>() - start;
  const double along = std::clamp(center.dot(way) / std::max(1e-9, way.squaredNorm()), 0.0, 1.0);
  return (center - along * way).norm() - cube.sizes().head<2>().norm() / 2 <= width;
}

int run(Cli& cli) {
  cli.outputs.checkFolder(cli.output, kFiles);
  bool isAllRead = true;
  const auto stored = inputs::openMap(cli.map, cli.memory, [&](const Eigen::AlignedBox3d& cube) {
    const bool isRead = isWanted(cli, cube);
    isAllRead = isAllRead && isRead;
    return isRead;
  });
  SemanticOcTree& map = stored->tree();
  const auto order = loadClassOrder(cli.order, map.classes());
  if (!cli.vehicle.empty()) cli.planner.vehicle = loadVehicle(cli.vehicle);
  measuring::Stopwatch watch;
  // First, for what that takes is free again before the ground needs it.
  std::optional<TileProgress> progress(std::in_place, std::vector{stored.get()}, "Drawing the map");
  MapCanvas canvas = MapCanvas::ofMap(map, {});
  watch.lap();
  const bool mayHaveGraph = !cli.planner.shorten || cli.planner.strict;
  const bool hasGraph = mayHaveGraph && isOfTree(cli.planner.roadmap.kind);
  progress.reset();
  if (hasGraph || !cli.weights.empty()) {
    progress.emplace(std::vector{stored.get()}, "Compressing");
    setAbstraction(map, cli.weights.empty() ? abstractionFor(order)
                                            : semantic_octree::loadSolution(
                                                  cli.weights, cli.solution, map.classes()));
  }
  const double abstraction = watch.lap();
  progress.emplace(std::vector{stored.get()}, "Finding the ground");
  SemanticPlanner planner(map, order, cli.planner);
  const double ground = watch.lap();
  progress.reset();
  std::optional<Progress> planning(std::in_place, "Planning", 0);
  planning->update(0, "a path");
  PlanResult plan = planner.plan(cli.start, cli.goal, cli.startZ, cli.goalZ);
  planning.reset();
  if (!plan.found() && !isAllRead) plan.reason += "; tiles beyond the --corridor were not read";
  nlohmann::json report = toJson(plan, order, map.classes());
  report["milliseconds"]["abstraction"] = abstraction;
  report["milliseconds"]["ground"] = ground;
  write(cli, std::move(canvas), planner, plan, report);
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
  CLI::App app("Plans the cheapest path of a vehicle over a semantic map");
  semantic_map_plan::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_plan::run(cli); });
}
