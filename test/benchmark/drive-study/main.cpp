// Drives through the synthetic worlds between random places, and counts what goes wrong.
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_planning/planner/OrderFile.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>
#include <synthetic_world/Scene.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "Application.h"
#include "ExploreTrial.h"
#include "Trial.h"

namespace drive_study {
namespace {

namespace fs = std::filesystem;

constexpr int kFaults = 2;              // exit status
constexpr double kStartsWithin = 0.84;  // of how far exploring goes from the world's middle
const std::vector<std::string> kFiles = {"study.json", "exploration.csv"};

struct Cli {
  fs::path order, config, output, weights;
  std::string solution;
  std::vector<std::string> scenes = synthetic_world::sceneNames();
  int pairs = 20;
  bool explore = false;
  std::uint64_t sceneSeed = 1;
  TaskOptions tasks;
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    addWords(app.add_option("--scenes", scenes, "Which synthetic worlds, separated by commas"),
             synthetic_world::sceneNames())
        ->delimiter(',')
        ->default_str("all");
    addNumber(app, "--pairs", pairs, strict_files::atLeast(0),
              "Drives in each world, from a random start to a random goal");
    CLI::Option* exploring =
        app.add_flag("--explore", explore,
                     "Instead of driving to goals, explore from the starts, once by each strategy");
    CLI::Option* file =
        app.add_option("--weights", weights, "What is looked for (YAML, see config/weights)");
    exploring->needs(file), file->needs(exploring);
    app.add_option("--solution", solution,
                   "Name of one solution in the weights; without: the first")
        ->type_name("NAME")
        ->needs(file);
    app.add_option("--scene-seed", sceneSeed, "Seed of the worlds")->capture_default_str();
    addOptions(app, strict_files::OptionList::of(tasks), "Start and goal");
    app.add_option("--order", order, "Classes from best to worst (YAML)")->required();
    app.add_option("--config", config, "Robot, sensors, planner (.ini, see config/drives)")
        ->required();
    outputs.add(app, output, "FOLDER", "Folder of the results, created if need be")->required();
  }
};

void print(const Trial& trial) {
  const std::string fault = trial.fault();
  notes() << trial.scene << ' ' << trial.number << ": " << nameOf(trial.record.end) << " after "
          << trial.record.duration() << " s and " << trial.record.length << " m; "
          << (trial.task.hasPath ? "there is a path" : "there is no path")
          << (fault.empty() ? "" : "; FAULT: " + fault) << std::endl;
  for (const std::string& reason : {trial.task.reason, trial.record.reason})
    if (!reason.empty()) notes() << "  " << reason << std::endl;
}

/** \return the number of faults */
int studyScene(const std::string& name, const Cli& cli, const simulated_drive::DriveConfig& config,
               const StopRequest& stop, nlohmann::json& trials) {
  int faults = 0;
  synthetic_world::Scene scene = synthetic_world::makeScene(name, cli.sceneSeed);
  const auto order = semantic_planning::loadClassOrder(cli.order, synthetic_world::classTable());
  TaskDraw draw(scene.world, order, config.planner.vehicle, cli.tasks);
  Oracle oracle(scene.world, order, config.planner, config.voxelSize);
  for (int i = 0; i < cli.pairs && !stop.pending(); ++i) {
    Task task = draw.next();
    while (!oracle.accepts(task)) task = draw.next();
    oracle.solve(task);
    simulated_drive::DriveConfig itsOwn = config;
    itsOwn.sensors.seed = cli.tasks.seed + static_cast<std::uint64_t>(i);
    Trial trial = runTrial(itsOwn, scene.world, order, task);
    trial.scene = name;
    trial.number = i;
    print(trial);
    trials.push_back(toJson(trial, order));
    faults += !trial.fault().empty();
  }
  return faults;
}

ExploreTask exploreTask(const Cli& cli) {
  ExploreTask task;
  task.weights =
      semantic_octree::loadSolution(cli.weights, cli.solution, synthetic_world::classTable())
          .weights;
  for (const auto& term : task.weights.terms)
    for (const auto& group : term.groups)
      for (const int id : group)
        if (term.weight > 0) task.classes.insert(static_cast<semantic_types::ClassId>(id));
  return task;
}

void print(const ExploreTrial& trial) {
  notes() << trial.scene << ' ' << trial.number << ", "
          << strict_files::nameIn(choicesOf(trial.how), trial.how) << ": 80 % after "
          << trial.metersTo(0.8) << " m, 90 % after " << trial.metersTo(0.9) << " m, "
          << std::lround(100 * trial.share()) << " % after " << trial.meters() << " m; ";
  if (const double r = trial.promiseAgainstWhatCame(); std::isfinite(r))
    notes() << "rank correlation of promises with what came " << std::round(100 * r) / 100 << "; ";
  notes() << trial.end << std::endl;
}

void exploreScene(const std::string& name, const Cli& cli,
                  const simulated_drive::DriveConfig& config, const StopRequest& stop,
                  std::vector<ExploreTrial>& trials) {
  const synthetic_world::Scene scene = synthetic_world::makeScene(name, cli.sceneSeed);
  const auto order = semantic_planning::loadClassOrder(cli.order, synthetic_world::classTable());
  const ExploreTask task = exploreTask(cli);
  TaskDraw draw(scene.world, order, config.planner.vehicle, cli.tasks);
  Oracle oracle(scene.world, order, config.planner, config.voxelSize);
  for (int i = 0; i < cli.pairs; ++i) {
    Task drawn;
    do drawn = draw.next();
    while (std::hypot(drawn.start.x, drawn.start.y) > kStartsWithin * task.within ||
           !oracle.accepts(drawn));
    const mrpt::math::TPose2D& start = drawn.start;
    for (const auto& [strategy, how] : choicesOf(Exploring())) {
      if (stop.pending()) continue;
      simulated_drive::DriveConfig itsOwn = config;
      itsOwn.sensors.seed = cli.tasks.seed + static_cast<std::uint64_t>(i);
      trials.push_back(explore(itsOwn, scene, order, task, start, how));
      trials.back().scene = name, trials.back().number = i;
      print(trials.back());
    }
  }
}

int runExploring(const Cli& cli, const simulated_drive::DriveConfig& config,
                 const StopRequest& stop) {
  strict_files::OutputFolder output(cli.output);
  std::vector<ExploreTrial> trials;
  for (const std::string& scene : cli.scenes) exploreScene(scene, cli, config, stop, trials);
  strict_files::writeText(output.staged("exploration.csv"), toCsv(trials));
  output.commit(kFiles);
  const bool touched = std::any_of(trials.begin(), trials.end(),
                                   [](const ExploreTrial& t) { return t.collisions > 0; });
  return touched ? kFaults : 0;
}

int run(const Cli& cli) {
  const StopRequest stop("after this drive");
  cli.outputs.checkFolder(cli.output, kFiles);
  const auto config = simulated_drive::loadDriveConfig(cli.config);
  if (cli.explore) return runExploring(cli, config, stop);
  strict_files::OutputFolder output(cli.output);
  nlohmann::json trials = nlohmann::json::array();
  int faults = 0;
  for (const std::string& scene : cli.scenes)
    faults += studyScene(scene, cli, config, stop, trials);
  writeJson(output.staged("study.json"), trials);
  output.commit(kFiles);
  notes() << faults << " of " << trials.size() << " drives with a fault\n";
  return faults == 0 ? 0 : kFaults;
}

}  // namespace
}  // namespace drive_study

int main(int argc, char** argv) {
  CLI::App app("Drives through synthetic worlds between random places, and counts what goes wrong");
  const drive_study::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return drive_study::run(cli); });
}
