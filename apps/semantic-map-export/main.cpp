// Writes a semantic octree map into files that other programs read.
#include <map_folders/MapFolder.h>

#include <algorithm>
#include <ostream>

#include "Application.h"
#include "Choice.h"
#include "Exporter.h"
#include "MemoryOption.h"
#include "OptionFlags.h"
#include "Outputs.h"
#include "StandardOutput.h"

namespace semantic_map_export {
namespace {

namespace fs = std::filesystem;
using semantic_octree::StoredMap;
using semantic_types::ClassTable;

struct Cli {
  fs::path map;
  std::vector<fs::path> files;
  std::vector<std::string> ground;
  ExportOptions options;
  double memory = semantic_octree::MapFolderOptions().memory;
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    app.add_option("MAP", map,
                   "A map's own file (.semantic), compressed or not, or a folder of tiles")
        ->required();
    addMemoryOption(app, memory);
    outputs
        .add(app, files, "FILE",
             "A file to write, may be given several times; its ending says what (" +
                 Exporter::formats() + ")")
        ->required();
    app.add_flag("!--no-colors", options.colors,
                 "Write an OcTree into .ot files, not a ColorOcTree");
    app.add_flag("--free", options.points.free, "Write free leaves, too, in .ply and .csv files");
    app.add_option("--max-height", options.maxHeight,
                   "Cut .png and .3Dscene files off above this height, m");
    strict_files::OptionList list;
    options.points.smoothing.describe(list);
    addOptions(app, list, "Neighbors, in .ply and .csv files");
    const std::string kGrids = "2D grids, .gridmap and .yaml files";
    strict_files::OptionList grid;
    options.grid.describe(grid);
    addOptions(app, grid, kGrids);
    app.add_option("--ground", ground,
                   "A class that is ground; may be given several times. "
                   "Without: the lowest voxel of each column is ground")
        ->allow_extra_args(false)
        ->group(kGrids);
    addCosts(app);
  }

 private:
  void addCosts(CLI::App& app) {
    auto* costs = app.add_option_group(
        "Costs", "What driving costs, in .yaml files, for nav2 and map_server");
    auto* order =
        costs->add_option("--costs", options.costs.order,
                          "Classes from best to worst (YAML): costs take the place of occupancy");
    costs
        ->add_option("--vehicle", options.costs.vehicle, "Its measures (YAML); none: a small robot")
        ->needs(order);
    addChoice<CostMode>(
        costs->add_option("--mode", options.costs.mode, "How the picture holds them"),
        {{"trinary", CostMode::Trinary}, {"scale", CostMode::Scale}, {"raw", CostMode::Raw}})
        ->needs(order);
  }
};

std::vector<semantic_types::ClassId> classesNamed(const std::vector<std::string>& names,
                                                  const ClassTable& classes) {
  std::vector<semantic_types::ClassId> ids;
  for (const std::string& name : names) {
    const auto id = classes.find(name);
    if (!id) throw std::runtime_error("--ground: the map has no class '" + name + "'");
    ids.push_back(*id);
  }
  return ids;
}

std::vector<fs::path> allFiles(const std::vector<fs::path>& files, const ExportOptions& options) {
  std::vector<fs::path> all;
  for (const fs::path& file : files)
    for (const fs::path& each : Exporter::filesOf(file, options)) all.push_back(each);
  return all;
}

bool hasScene(const std::vector<fs::path>& files) {
  return std::any_of(files.begin(), files.end(),
                     [](const fs::path& file) { return file.extension() == ".3Dscene"; });
}

/** A scene is made of a copy of the map; neighbors may lie in other tiles than what is gone
 * through. */
void prepare(semantic_octree::MapFolder& folder, const Cli& cli) {
  if (hasScene(cli.files)) folder.checkFits();
  if (cli.options.points.smoothing.neighborWeight > 0) folder.bringAll();
}

int run(const Cli& cli) {
  cli.outputs.check(allFiles(cli.files, cli.options));
  StoredMap map(cli.map, cli.memory);
  if (map.folder()) prepare(*map.folder(), cli);
  ExportOptions options = cli.options;
  options.grid.ground = classesNamed(cli.ground, map.tree().classes());
  Exporter exporter(map.tree(), options);
  for (const fs::path& file : cli.files) exporter.write(file);
  for (const fs::path& file : exporter.commit()) notes() << file.string() << '\n';
  return 0;
}

}  // namespace
}  // namespace semantic_map_export

int main(int argc, char** argv) {
  CLI::App app("Writes a semantic octree map into files that other programs read");
  const semantic_map_export::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_export::run(cli); });
}
