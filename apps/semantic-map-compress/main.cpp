// Compresses a semantic octree map to its optimal trees for given weights of the classes.
#include <map_operations/MapOperations.h>
#include <map_pictures/MapPictures.h>
#include <semantic_octree/TreeFile.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <cmath>
#include <iomanip>
#include <optional>
#include <utility>

#include "Application.h"
#include "Report.h"
#include "inputs/Inputs.h"

namespace semantic_map_compress {
namespace {

namespace fs = std::filesystem;
using semantic_octree::SemanticOcTree;
using strict_files::OutputFolder;

struct Cli {
  fs::path map, weights, output;
  Target target;
  double memory = semantic_octree::MapFolderOptions().memory;
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    inputs::addMap(app, map);
    app.add_option(
        "--weights", weights,
        "Weights of classes (YAML), one or several solutions; without: every class counts alike, "
        "and a tenth of the leaves is kept");
    outputs.add(app, output, "FOLDER", "Folder of the results, created if need be")->required();
    auto* group = app.add_option_group("size", "Instead of each solution's own alpha");
    group->add_option("--alpha", target.alpha, "Price of a leaf (alpha): a higher one keeps fewer")
        ->check(isNumber(strict_files::atLeast(0)));
    group
        ->add_option_function<std::string>(
            "--leaves", [this](const std::string& text) { readLeaves(text); },
            "The largest tree with at most this many leaves, or this share of them: 10%")
        ->type_name("NUMBER[%]");
    group
        ->add_option("--bytes", target.bytes,
                     "The largest tree whose file has at most this many bytes")
        ->check(isNumber(strict_files::above(0)));
    group->require_option(0, 1);
    addMemoryOption(app, memory);
  }

 private:
  /** "500" or "10%" */
  void readLeaves(const std::string& text) {
    const bool isShare = !text.empty() && text.back() == '%';
    double number = 0;
    try {
      number = strict_files::numberOf(isShare ? text.substr(0, text.size() - 1) : text);
    } catch (const std::invalid_argument&) {
    }
    if (!(number > 0) || number > (isShare ? 100 : 1e15))
      throw CLI::ValidationError(
          "--leaves", "is '" + text + "', expected a number above 0, or a share up to 100%");
    if (isShare)
      target.share = number / 100;
    else
      target.leaves = static_cast<std::size_t>(number);
  }
};

Target targetOf(const Cli& cli) {
  Target target = cli.target;
  const bool isOpen = !target.alpha && !target.leaves && !target.share && !target.bytes;
  if (isOpen && cli.weights.empty()) target.share = 0.1;
  return target;
}

/** Alpha is NaN where nothing says it. */
std::vector<AbstractionOptions> solutionsOf(const Cli& cli,
                                            const semantic_types::ClassTable& classes) {
  if (!cli.weights.empty()) return semantic_octree::loadWeights(cli.weights, classes, NAN);
  return semantic_octree::weightsOfText("{name: all-classes, everything: 1}", "without --weights",
                                        classes);
}

/** Puts everything about one solution into the folder, and onto the sheet. */
Compression writeSolution(const AbstractionOptions& solution, const Target& target,
                          Compressor& compressor, const OutputFolder& output, MapSheet& sheet) {
  Compression c;
  c.solution = solution;
  c.alpha = compressor.alphaFor(solution, target);
  c.times.add("chooseAlpha");
  compressor.weigh(solution, c.alpha);
  c.times.add("weigh");
  c.measures = compressor.abstraction().measures();
  c.kept = compressor.kept(c.measures);
  c.chosen = curvePoint(compressor, c.measures);
  c.times.add("measure");
  const auto compressed = compressor.compressed();
  c.times.add("extract");
  const fs::path file = output.staged(solution.name + ".semantic");
  saveTree(compressed->tree(), file.string());
  c.bytes = fs::file_size(file);
  c.times.add("save");
  map_pictures::PictureStyle style;
  style.title = solution.name;
  map_pictures::savePicture(renderTopView(compressed->tree(), style),
                            output.staged(solution.name + ".top.png"));
  sheet.add(
      compressed->tree(),
      solution.name + ": " + std::to_string(c.measures.compressed.numKnownLeaves) + " leaves");
  c.times.add("draw");
  c.curve = alphaCurve(compressor);
  c.times.add("curve");
  return c;
}

/** Maps are worth keeping without figures: says what is wrong instead of throwing. */
std::string drawFigures(const FullMap& map, const std::vector<Compression>& compressions,
                        const TermCatalog& catalog, const OutputFolder& output) {
  try {
    drawRetained(map, compressions, catalog, output.staged("retained.png"));
    drawCurves(compressions, output.staged("curves.png"));
    return {};
  } catch (const std::exception& e) {
    return std::string("no figures retained.png, curves.png: ") + e.what();
  }
}

std::vector<std::string> fileNames(const std::vector<AbstractionOptions>& solutions) {
  std::vector<std::string> names = {"report.json", "report.csv", "maps.png", "retained.png",
                                    "curves.png"};
  for (const AbstractionOptions& solution : solutions)
    for (const char* ending : {".semantic", ".top.png"}) names.push_back(solution.name + ending);
  return names;
}

void printSummary(const std::vector<Compression>& compressions) {
  for (const Compression& c : compressions)
    notes() << c.solution.name << ": alpha " << c.alpha << ", "
            << c.measures.compressed.numKnownLeaves << " of " << c.measures.full.numKnownLeaves
            << " leaves (" << std::setprecision(3) << 100 * c.leafRatio() << std::setprecision(6)
            << " %), " << strict_files::sizeText(c.bytes) << '\n';
}

int run(const Cli& cli) {
  StageTimer times;
  const double memory = cli.memory / 2;  // the other half is for compressed maps
  const auto stored = inputs::openMap(cli.map, memory);
  SemanticOcTree& map = stored->tree();
  const FullMap full{cli.map.string(), map.getResolution(), map.size(),
                     stored->folder() ? stored->bytesOnDisk() : fs::file_size(cli.map),
                     contentsOf(map).voxelsOfClass};
  const std::vector<AbstractionOptions> solutions = solutionsOf(cli, map.classes());
  cli.outputs.checkFolder(cli.output, fileNames(solutions));
  times.add("load");
  const TermCatalog catalog(map.classes(), solutions);
  OutputFolder output(cli.output);
  std::optional<semantic_octree::MapFolderOptions> tiles;
  if (stored->folder()) tiles = {memory, stored->folder()->contents().tileSize};
  std::optional<Progress> progress(std::in_place, "Compressing", solutions.size() + 2);
  progress->update(0, "information of the classes");
  Compressor compressor(map, catalog, solutions.front(), tiles, output.staged("tiles"));
  times.add("computeInformation");

  MapSheet sheet(1 + solutions.size());
  sheet.add(map, "full map: " + std::to_string(map.getNumLeafNodes()) + " leaves");
  std::vector<Compression> compressions;
  for (const AbstractionOptions& solution : solutions) {
    progress->update(2 + compressions.size(), solution.name);
    compressions.push_back(writeSolution(solution, targetOf(cli), compressor, output, sheet));
  }
  times.add("solutions");
  progress.reset();

  map_pictures::savePicture(sheet.picture(), output.staged("maps.png"));
  const std::string problem = drawFigures(full, compressions, catalog, output);
  times.add("figures");
  const nlohmann::ordered_json report = toJson(full, catalog, compressions, times);
  strict_files::writeText(output.staged("report.csv"), toCsv(report));
  writeJson(output.staged("report.json"), report);
  output.commit(fileNames(solutions));
  printSummary(compressions);
  if (!problem.empty()) throw std::runtime_error(problem);
  return 0;
}

}  // namespace
}  // namespace semantic_map_compress

int main(int argc, char** argv) {
  CLI::App app(
      "Compresses a semantic octree map to what matters: the best tree for weights of its classes");
  const semantic_map_compress::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_compress::run(cli); });
}
