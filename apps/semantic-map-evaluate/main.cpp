// Asks maps for the classes of labeled points that they were not made from.
#include <labeled_cloud/ScanStream.h>
#include <labeled_cloud/Trajectory.h>
#include <strict_files/OutputFiles.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <list>
#include <memory>
#include <ostream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "Application.h"
#include "Evaluation.h"
#include "figures/FigureScript.h"
#include "inputs/Inputs.h"

namespace semantic_map_evaluate {
namespace {
using namespace figures;

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using semantic_octree::ClassTable;
using semantic_octree::SmoothedView;

struct NamedEvaluation {
  std::string name;
  Evaluation evaluation;
};

/** Bins of fewer points than this share of all are not drawn: their share is chance. */
constexpr double kLeast = 2e-4;

/** Data of a map: stated and right, percent, and the share of the points, percent. */
void writeData(std::ostream& out, const NamedEvaluation& map, std::size_t i) {
  out << "$map" << i << " << EOD\n";
  const auto all = static_cast<double>(map.evaluation.answered());
  for (const Evaluation::Bin& bin : map.evaluation.reliability())
    if (const auto points = static_cast<double>(bin.points); points > kLeast * all)
      out << 100 * bin.meanStated() << ' ' << 100 * bin.shareRight() << ' ' << 100 * points / all
          << '\n';
  if (all == 0) out << "-1 -1 -1\n";  // outside of the axes: gnuplot complains of no points
  out << "EOD\n";
}

/** A line for each map. \param columns of the data \param titled whether they are in the key */
std::string linesOf(const std::vector<NamedEvaluation>& maps, const std::string& columns,
                    bool titled) {
  std::string plots;
  for (std::size_t i = 0; i < maps.size(); ++i)
    plots += ", $map" + std::to_string(i) + " using " + columns + " with linespoints" + styleOf(i) +
             " lw 2 ps 0.8 " + (titled ? "title " + gnuplotText(maps[i].name) : "notitle");
  return plots;
}

/** Reliability diagram: the share of points that is right over the probability that the maps state,
 * above the shares of the points. \throw std::runtime_error gnuplot is missing, or fails. */
void drawReliability(const std::vector<NamedEvaluation>& maps, const std::filesystem::path& file) {
  auto out = scriptFor(760, 820);
  for (std::size_t i = 0; i < maps.size(); ++i) writeData(out, maps[i], i);
  out << "set multiplot\nset lmargin 10; set rmargin 3\nset xrange [0:100]\n"
      << "set tmargin at screen 0.97; set bmargin at screen 0.36\n"
      << "set ylabel 'points that are right [%]'\nset yrange [0:100]\n"
      << "set key right bottom samplen 2\nset format x ''\n"
      << "plot x with lines dt 2 lc rgb '#808080' title 'as stated'" << linesOf(maps, "1:2", true)
      << "\nset tmargin at screen 0.31; set bmargin at screen 0.08\nset format x\n"
      << "set xlabel 'stated probability of the class, where occupied [%]'\n"
      << "set ylabel 'share of the points [%]'\nset yrange [0.02:100]\nset logscale y\n"
      << "plot NaN notitle" << linesOf(maps, "1:3", false) << "\nunset multiplot\n";
  drawWithGnuplot(out.str(), file);
}

const std::vector<std::string> kFiles = {"quality.json", "reliability.png"};

struct Cli {
  std::vector<fs::path> maps, rawlogs, madeFrom;
  fs::path output;
  double maxRange = HUGE_VAL;
  double memory = semantic_octree::MapFolderOptions().memory;
  semantic_octree::SmoothingOptions smoothing{0};
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    app.add_option("MAPS", maps, std::string("Maps, compressed or not: ") + inputs::kMap)
        ->required();
    app.add_option("--scans", rawlogs, "Rawlogs of labeled scans that the maps were not made from")
        ->required();
    app.add_option("--made-from", madeFrom,
                   "Rawlogs that the maps were made from: two more rows of results, for plain "
                   "counts of labels in each voxel");
    outputs.add(app, output, "FOLDER", "Folder of the results, created if need be")->required();
    app.add_option("--max-range", maxRange, "Leave out points farther from the sensor than this, m")
        ->check(isNumber(strict_files::above(0)));
    addOptions(app, strict_files::OptionList::of(smoothing), "Neighbors");
    addMemoryOption(app, memory);
  }
};

/** A map and what came of its questions. */
struct Asked {
  Asked(const fs::path& map, double memory, const semantic_octree::SmoothingOptions& smoothing)
      : file(map),
        stored(inputs::openMap(map, memory)),
        view(stored->tree(), smoothing),
        result{map.stem().string(), Evaluation(stored->tree().numClasses())} {}

  const ClassTable& classes() { return stored->tree().classes(); }

  fs::path file;
  std::unique_ptr<semantic_octree::StoredMap> stored;
  SmoothedView view;
  NamedEvaluation result;
};

/** Counted labels, and what came of their questions. */
struct Counting {
  LabelCounts counts;
  NamedEvaluation result;
};

void ask(const labeled_cloud::LabeledScan& scan, const mrpt::poses::CPose3D& T_map_robot,
         double maxRange, std::list<Asked>& maps, std::list<Counting>& peers) {
  const Eigen::Isometry3d T = labeled_cloud::toEigen(T_map_robot + scan.T_robot_sensor);
  for (std::size_t i = 0; i < scan.cloud.classes.size(); ++i) {
    const auto truth = scan.cloud.classes[i];
    const Eigen::Vector3f& point = scan.cloud.points[i];
    if (truth == semantic_octree::kNoClass || point.norm() > maxRange) continue;
    const Eigen::Vector3d inMap = T * point.cast<double>();
    for (Asked& asked : maps) asked.result.evaluation.ask(asked.view, inMap, truth);
    for (Counting& peer : peers)
      peer.result.evaluation.add(peer.counts.answer(inMap, truth), truth);
  }
}

/** Maps whose files have one name are called by their paths. \throw std::runtime_error maps of
 * other classes, or one map twice. */
void requireComparable(std::list<Asked>& maps) {
  std::multiset<std::string> stems;
  for (const Asked& asked : maps) stems.insert(asked.file.stem());
  std::set<std::string> names;
  for (Asked& asked : maps) {
    std::string& name = asked.result.name;
    if (stems.count(name) > 1) name = fs::path(asked.file).replace_extension();
    if (asked.classes() != maps.front().classes())
      throw std::runtime_error("maps of different classes: " + maps.front().result.name + ", " +
                               name);
    if (!names.insert(name).second) throw std::runtime_error(name + " is given twice");
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
          {"meanRecall", e.meanRecall()},
          {"stated", e.meanStated()},
          {"logLoss", e.logLoss()},
          {"calibrationError", e.calibrationError()},
          {"reliability", reliability},
          {"classes", ofClass}};
}

/** \return why there is no diagram; empty if there is one */
std::string writeResults(const Cli& cli, const std::vector<NamedEvaluation>& results,
                         const ClassTable& classes) {
  strict_files::OutputFolder output(cli.output);
  ordered_json report = ordered_json::object();
  for (const NamedEvaluation& result : results)
    report[result.name] = toJson(result.evaluation, classes);
  writeJson(output.staged("quality.json"), report);
  std::string problem;
  try {
    drawReliability(results, output.staged("reliability.png"));
  } catch (const std::exception& e) {
    problem = std::string("no figure reliability.png: ") + e.what();
  }
  output.commit(kFiles);
  return problem;
}

/** "1200 points", "1.20 M points" */
std::string pointsText(std::size_t points) {
  std::ostringstream text;
  if (points < 100000)
    text << points;
  else
    text << std::fixed << std::setprecision(2) << static_cast<double>(points) / 1e6 << " M";
  text << " points";
  return text.str();
}

/** "97.5"; of no points: "-" */
std::string numberText(double number, int decimals) {
  if (std::isnan(number)) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << number;
  return text.str();
}

/** A sentence on the first map, and a line for each. */
std::string tableOf(const std::vector<NamedEvaluation>& results) {
  std::size_t width = 0;
  for (const NamedEvaluation& result : results) width = std::max(width, result.name.size());
  const Evaluation& first = results.front().evaluation;
  std::ostringstream text;
  text << results.front().name << ": " << numberText(100 * first.coverage(), 1) << " % of "
       << pointsText(first.points()) << " lie in occupied voxels";
  if (first.answered() > 0)
    text << "; " << numberText(100 * first.accuracy(), 1)
         << " % of these, where the voxel names a class, have the right class";
  text << '\n'
       << std::string(width, ' ') << "  occupied  right  stated  recall  log loss  calibration\n";
  for (const auto& [name, e] : results)
    text << name << std::string(width - name.size(), ' ') << std::setw(8)
         << numberText(100 * e.coverage(), 1) << " %" << std::setw(7)
         << numberText(100 * e.accuracy(), 1) << std::setw(8) << numberText(100 * e.meanStated(), 1)
         << std::setw(8) << numberText(100 * e.meanRecall(), 1) << std::setw(10)
         << numberText(e.logLoss(), 3) << std::setw(13) << numberText(e.calibrationError(), 3)
         << '\n';
  return text.str();
}

/** What to think of when most points are where a map has nothing. */
std::string doubtsOf(const std::vector<NamedEvaluation>& results) {
  constexpr double kSamePlace = 0.5;
  std::ostringstream text;
  for (const auto& [name, e] : results)
    if (e.coverage() < kSamePlace)
      text << name << ": only " << std::lround(100 * e.coverage())
           << " % of the points are in the map: is it of the same place, in the same frame?\n";
  return text.str();
}

/** Calls f(scan, T_map_robot) for each scan of rawlogs. \param task what that does, for people */
template <typename F>
void forEachScan(const std::string& task, const std::vector<fs::path>& rawlogs,
                 const ClassTable& classes, const F& f) {
  const auto trajectory = labeled_cloud::readTrajectory(rawlogs);
  labeled_cloud::ScanConverter converter(classes);
  labeled_cloud::ScanStream stream(rawlogs, converter, trajectory, nullptr);
  std::uint64_t bytes = 0;
  for (const fs::path& file : rawlogs) bytes += fs::file_size(file);
  Progress progress(task, bytes);
  std::size_t scans = 0;
  while (const auto observation = stream.next()) {
    if (!observation->scan) continue;
    f(*observation->scan, observation->T_map_robot);
    progress.update(observation->bytesRead, std::to_string(++scans) + " scans");
  }
}

/** Labels that the maps were made from, counted in the first map's voxels. */
std::list<Counting> countLabels(const Cli& cli, Asked& first) {
  std::list<Counting> peers;
  if (cli.madeFrom.empty()) return peers;
  const semantic_octree::SemanticOcTree& map = first.stored->tree();
  const Evaluation none(map.numClasses());
  peers.push_back({{map, LabelCounts::Counted::Labels}, {"labels counted", none}});
  peers.push_back({{map, LabelCounts::Counted::Scans}, {"scans counted", none}});
  forEachScan("Counting labels", cli.madeFrom, first.classes(),
              [&](const auto& scan, const auto& T_map_robot) {
                const Eigen::Isometry3d T =
                    labeled_cloud::toEigen(T_map_robot + scan.T_robot_sensor);
                for (Counting& peer : peers) peer.counts.add(scan.cloud, T);
              });
  return peers;
}

int run(const Cli& cli) {
  cli.outputs.checkFolder(cli.output, kFiles);
  inputs::checkRawlogs(cli.madeFrom);
  inputs::checkRawlogs(cli.rawlogs);
  std::list<Asked> maps;
  for (const fs::path& file : cli.maps) {
    const double memory = cli.memory / static_cast<double>(cli.maps.size());
    maps.emplace_back(file, memory, cli.smoothing);
  }
  requireComparable(maps);
  std::list<Counting> peers = countLabels(cli, maps.front());
  forEachScan("Asking", cli.rawlogs, maps.front().classes(),
              [&](const auto& scan, const auto& T_map_robot) {
                ask(scan, T_map_robot, cli.maxRange, maps, peers);
              });
  std::vector<NamedEvaluation> results;
  for (const Asked& asked : maps) results.push_back(asked.result);
  for (const Counting& peer : peers) results.push_back(peer.result);
  if (results.front().evaluation.points() == 0)
    throw std::runtime_error("no point of the scans has a class");
  const std::string problem = writeResults(cli, results, maps.front().classes());
  notes() << tableOf(results) << doubtsOf(results);
  if (!problem.empty()) throw std::runtime_error(problem);
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
