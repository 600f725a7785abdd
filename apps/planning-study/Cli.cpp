#include "Cli.h"

#include <algorithm>
#include <stdexcept>

#include "Choice.h"
#include "NumberChecks.h"
#include "OptionFlags.h"

namespace planning_study {

using semantic_planning::GraphKind;

namespace {

void addGraphs(CLI::App& app, StudyOptions& study) {
  const auto& kinds = choicesOf(GraphKind());
  auto* group = app.add_option_group("Graphs");
  group->add_option("--budgets", study.budgets, "Vertices of each graph, separated by commas")
      ->delimiter(',')
      ->check(isNumber(strict_files::above(0)))
      ->capture_default_str();
  addChoice(group->add_option("--graphs", study.graphs,
                              "Their kinds; the first is compared with the others"),
            std::map<std::string, GraphKind>(kinds.begin(), kinds.end()))
      ->delimiter(',');
  group->add_option("--edges-per-vertex", study.edgesPerVertex, "Most edges of all graphs")
      ->check(isNumber(strict_files::above(0)))
      ->capture_default_str();
  group->add_option("--reference", study.reference, "Vertices of the dense graph; 0: none")
      ->capture_default_str();
}

void addPeers(CLI::App& app, StudyOptions& study) {
  auto* group = app.add_option_group("Peers");
  group->add_flag("--peers", study.peers, "OMPL's PRM*, LazyPRM* and BIT*, too");
  group->add_option("--peer-time", study.peerTimes, "Of each, processor seconds; several by commas")
      ->delimiter(',')
      ->check(isNumber(strict_files::above(0)))
      ->capture_default_str();
  group->add_option("--peer-instances", study.peerInstances, "They get the first ones only")
      ->capture_default_str();
}

std::string nameOf(const std::filesystem::path& map) {
  const std::string stem = map.stem().string();
  return stem == "map" ? std::filesystem::absolute(map).parent_path().filename().string() : stem;
}

}  // namespace

Cli::Cli(CLI::App& app) : outputs(app) {
  study.planner.roadmap.headings = 1;  // as in the paper, and random ones
  study.planner.roadmap.alignHeadings = false;
  study.graphs = {GraphKind::Compressed, GraphKind::Leaves, GraphKind::Halton,
                  GraphKind::HaltonDrivable, GraphKind::Full};
  addTo(app);
}

void Cli::addTo(CLI::App& app) {
  app.add_option("MAP", maps, "Maps' own files (.semantic)")->required();
  auto* what = app.add_option_group("What is done")->require_option(1);
  what->add_option("--classes", classes, "Classes from best to worst (YAML)");
  what->add_flag("--join", join, "MAPs are folders of results, of the same options: join them");
  app.add_option("--vehicle", vehicle, "Its measures (YAML); none: a small robot");
  outputs.add(app, output, "FOLDER", "Folder of the results, created if need be")->required();
  app.add_option("--instances", study.instances, "Pairs of start and goal on each map")
      ->check(isNumber(strict_files::above(0)))
      ->capture_default_str();
  app.add_option("--seed", study.seed, "Other instances")->capture_default_str();
  app.add_option("--min-distance", study.minDistance, "From start to goal, m")
      ->check(isNumber(strict_files::above(0)))
      ->capture_default_str();
  app.add_option("--minutes", study.minutes, "No new instance after these (of the clock)")
      ->check(isNumber(strict_files::above(0)));
  app.add_option("--weights", study.weights,
                 "What the compressed tree keeps (YAML); none: what tells the ranks apart");
  app.add_option("--solution", study.solution, "Which of the weights; none: the first")
      ->needs("--weights");
  addGraphs(app, study);
  addOptions(app, sharedOptions(study.planner), "Planner");
  addPeers(app, study);
}

std::vector<std::string> namesOf(const std::vector<std::filesystem::path>& maps) {
  std::vector<std::string> names;
  for (const auto& map : maps) {
    if (std::find(names.begin(), names.end(), nameOf(map)) != names.end())
      throw std::runtime_error(map.string() + ": a second map that is called " + nameOf(map));
    names.push_back(nameOf(map));
  }
  return names;
}

}  // namespace planning_study
