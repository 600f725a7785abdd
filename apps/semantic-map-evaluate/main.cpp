// Asks maps for the classes of labeled points that they were not made from.
#include <labeled_cloud/EigenPose.h>
#include <labeled_cloud/RawlogTrajectory.h>
#include <labeled_cloud/ScanStream.h>
#include <map_folders/MapFolder.h>
#include <strict_files/OutputFolder.h>

#include <cmath>
#include <list>
#include <ostream>
#include <set>

#include "Application.h"
#include "Figures.h"
#include "JsonFile.h"
#include "MemoryOption.h"
#include "NumberChecks.h"
#include "OptionFlags.h"
#include "Outputs.h"
#include "StandardOutput.h"

namespace semantic_map_evaluate {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using semantic_octree::ClassTable;
using semantic_octree::SmoothedView;

const std::vector<std::string> kFiles = {"quality.json", "reliability.png"};

struct Cli {
  std::vector<fs::path> maps, rawlogs;
  fs::path output;
  double maxRange = HUGE_VAL;
  double memory = semantic_octree::MapFolderOptions().memory;
  semantic_octree::SmoothingOptions smoothing{0};
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    app.add_option("MAPS", maps,
                   "Maps' own files (.semantic), compressed or not, or folders of tiles")
        ->required();
    app.add_option("--scans", rawlogs, "Rawlogs of labeled scans that the maps were not made from")
        ->required();
    outputs.add(app, output, "FOLDER", "Folder of the results, created if need be")->required();
    app.add_option("--max-range", maxRange, "Points farther from the sensor are not asked for, m")
        ->check(isNumber(strict_files::above(0)));
    strict_files::OptionList list;
    smoothing.describe(list);
    addOptions(app, list, "Neighbors");
    addMemoryOption(app, memory);
  }
};

/** A map and what came of its questions. */
struct Asked {
  Asked(const fs::path& file, double memory, const semantic_octree::SmoothingOptions& smoothing)
      : stored(file, memory),
        view(stored.tree(), smoothing),
        result{file.stem().string(), Evaluation(stored.tree().numClasses())} {}

  const ClassTable& classes() { return stored.tree().classes(); }

  semantic_octree::StoredMap stored;
  SmoothedView view;
  NamedEvaluation result;
};

void ask(const labeled_cloud::LabeledScan& scan, const mrpt::poses::CPose3D& T_map_robot,
         double maxRange, std::list<Asked>& maps) {
  const Eigen::Isometry3d T = labeled_cloud::toEigen(T_map_robot + scan.T_robot_sensor);
  for (std::size_t i = 0; i < scan.cloud.classes.size(); ++i) {
    const auto truth = scan.cloud.classes[i];
    const Eigen::Vector3f& point = scan.cloud.points[i];
    if (truth == semantic_octree::kNoClass || point.norm() > maxRange) continue;
    for (Asked& asked : maps)
      asked.result.evaluation.ask(asked.view, T * point.cast<double>(), truth);
  }
}

/** \throw std::runtime_error maps of other classes, or of one name. */
void requireComparable(std::list<Asked>& maps) {
  std::set<std::string> names;
  for (Asked& asked : maps) {
    const std::string& name = asked.result.name;
    if (asked.classes() != maps.front().classes())
      throw std::runtime_error("maps of different classes: " + maps.front().result.name + ", " +
                               name);
    if (!names.insert(name).second) throw std::runtime_error("two maps by the name of " + name);
  }
}

ordered_json binJson(const Evaluation::Bin& bin) {
  return {{"points", bin.points}, {"stated", bin.meanStated()}, {"right", bin.shareRight()}};
}

ordered_json toJson(const Evaluation& e, const ClassTable& classes) {
  ordered_json reliability = ordered_json::array(), ofClass = ordered_json::object();
  for (const auto& bin : e.reliability())
    if (bin.points > 0) reliability.push_back(binJson(bin));
  for (std::size_t id = 1; id < e.ofClass().size(); ++id)
    if (e.ofClass()[id].points > 0)
      ofClass[classes.name(static_cast<semantic_octree::ClassId>(id))] = binJson(e.ofClass()[id]);
  return {{"points", e.points()},
          {"coverage", e.coverage()},
          {"rightOfAll", e.rightOfAll()},
          {"answered", e.answered()},
          {"accuracy", e.accuracy()},
          {"logLoss", e.logLoss()},
          {"calibrationError", e.calibrationError()},
          {"reliability", reliability},
          {"classes", ofClass}};
}

void writeResults(const Cli& cli, std::list<Asked>& maps) {
  strict_files::OutputFolder output(cli.output);
  std::vector<NamedEvaluation> results;
  ordered_json report = ordered_json::object();
  for (Asked& asked : maps) {
    results.push_back(asked.result);
    report[asked.result.name] = toJson(asked.result.evaluation, asked.classes());
  }
  writeJson(output.staged("quality.json"), report);
  drawReliability(results, output.staged("reliability.png"));
  output.commit(kFiles);
}

int run(const Cli& cli) {
  cli.outputs.checkFolder(cli.output, kFiles);
  std::list<Asked> maps;
  for (const fs::path& file : cli.maps) {
    const double memory = cli.memory / static_cast<double>(cli.maps.size());
    maps.emplace_back(file, memory, cli.smoothing);
  }
  requireComparable(maps);
  const auto trajectory = labeled_cloud::readTrajectory(cli.rawlogs);
  labeled_cloud::ScanConverter converter(maps.front().classes());
  labeled_cloud::ScanStream stream(cli.rawlogs, converter, trajectory, nullptr);
  while (const auto observation = stream.next())
    if (observation->scan) ask(*observation->scan, observation->T_map_robot, cli.maxRange, maps);
  if (maps.front().result.evaluation.points() == 0)
    throw std::runtime_error("no point of the scans has a class");
  writeResults(cli, maps);
  for (const Asked& asked : maps) {
    const Evaluation& e = asked.result.evaluation;
    notes() << asked.result.name << ": right " << 100 * e.accuracy() << " % of "
            << 100 * e.coverage() << " % of " << e.points() << " points, log loss " << e.logLoss()
            << ", calibration error " << e.calibrationError() << '\n';
  }
  return 0;
}

}  // namespace
}  // namespace semantic_map_evaluate

int main(int argc, char** argv) {
  CLI::App app(
      "Asks maps for the classes of labeled points, and compares what they state with what is "
      "right");
  const semantic_map_evaluate::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_evaluate::run(cli); });
}
