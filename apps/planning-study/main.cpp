// Compares kinds of graphs, and other planners, on random tasks over semantic maps.
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/vehicle/VehicleOptions.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>

#include <ostream>

#include "Application.h"
#include "Cli.h"
#include "Join.h"
#include "JsonFile.h"
#include "Signals.h"
#include "StandardOutput.h"
#include "StudyFigures.h"
#include "StudyTables.h"
#include "Summary.h"
#include "measuring/Stopwatch.h"

namespace planning_study {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kFiles = {"study.csv", "study.json", "study.md", "times.png",
                                         "paths.png"};

/** Maps take turns, so that each has the same number of instances when time is over. */
std::vector<MapStudy> studyMaps(const Cli& cli, const StopRequest& stop) {
  const measuring::Stopwatch watch;
  const double most = cli.study.minutes * 60e3;  // ms
  const std::vector<std::string> names = namesOf(cli.maps);
  std::vector<StudyRunner> runners;
  for (std::size_t i = 0; i < names.size(); ++i)
    runners.emplace_back(names[i], cli.maps[i].string(), cli.classes.string(), cli.study);
  std::size_t done = 0;
  while (done < cli.study.instances &&
         (done == 0 || (watch.milliseconds() < most && !stop.pending()))) {
    for (StudyRunner& runner : runners) runner.runNextInstance();
    if (++done % 10 == 0) notes() << done << " of " << cli.study.instances << std::endl;
  }
  std::vector<MapStudy> studies;
  for (const StudyRunner& runner : runners) studies.push_back(runner.study());
  return studies;
}

/** Numbers are worth keeping without figures: says what is wrong instead of throwing. */
std::string drawFigures(const nlohmann::ordered_json& study,
                        const strict_files::OutputFolder& output) {
  try {
    drawTimes(study, output.staged("times.png"));
    drawPaths(study, output.staged("paths.png"));
    return {};
  } catch (const std::exception& e) {
    return std::string("no figures times.png, paths.png: ") + e.what();
  }
}

std::vector<fs::path> filesOf(const std::vector<fs::path>& studies) {
  std::vector<fs::path> files;
  for (const fs::path& folder : studies)
    for (const std::string& name : kFiles) files.push_back(folder / name);
  return files;
}

JoinedStudy study(Cli& cli, const StopRequest& stop) {
  cli.study.validate();
  if (!cli.vehicle.empty()) cli.study.planner.vehicle = semantic_planning::loadVehicle(cli.vehicle);
  auto& vehicle = cli.study.planner.vehicle;  // direction costs nothing, as in the paper
  vehicle.reverseWeight = 1;
  vehicle.gearChange = vehicle.steeringChange = 0;
  const std::vector<MapStudy> studies = studyMaps(cli, stop);
  return {toJson(studies, cli.study), toCsv(studies)};
}

int run(Cli& cli) {
  const StopRequest stop("after this instance");
  cli.outputs.checkFolder(cli.output, kFiles, cli.join ? filesOf(cli.maps) : cli.maps);
  strict_files::OutputFolder output(cli.output);
  const auto [json, csv] = cli.join ? joinStudies(cli.maps) : study(cli, stop);
  strict_files::writeText(output.staged("study.csv"), csv);
  writeJson(output.staged("study.json"), json);
  strict_files::writeText(output.staged("study.md"), toMarkdown(json));
  const std::string problem = drawFigures(json, output);
  output.commit(kFiles);
  if (!problem.empty()) throw std::runtime_error(problem);
  return 0;
}

}  // namespace
}  // namespace planning_study

int main(int argc, char** argv) {
  CLI::App app("Compares kinds of graphs, and other planners, on random tasks over semantic maps");
  planning_study::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return planning_study::run(cli); });
}
