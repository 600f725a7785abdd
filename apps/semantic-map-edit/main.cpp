// Crops, coarsens, moves and ages a semantic octree map, puts it into tiles, and imports maps of
// OctoMap's.
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <semantic_map/MapFiles.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_types/ClassTable.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "Application.h"
#include "inputs/Inputs.h"
#include "poses/Poses.h"

namespace semantic_map_edit {
namespace {

namespace fs = std::filesystem;
using semantic_octree::MapFolder;
using semantic_octree::SemanticOcTree;
using semantic_octree::StoredMap;

struct Cli {
  fs::path in, out, like, halfLives;
  std::optional<std::array<double, 6>> pose, box;
  std::optional<double> resolution, tiles, decay;
  double memory = semantic_octree::MapFolderOptions().memory;
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    inputs::addMap(app, in);
    outputs.add(app, out, "FILE|FOLDER", "The map to write (.semantic); with --tiles, its folder")
        ->required();
    app.add_option("--pose", pose, "Where the map's origin is in the new map, m and degrees")
        ->type_name("X,Y,Z,YAW,PITCH,ROLL")
        ->delimiter(',');
    app.add_option("--box", box, "Keep what is in this box, m")
        ->type_name("X,Y,Z,X2,Y2,Z2")
        ->delimiter(',');
    app.add_option("--resolution", resolution,
                   "Coarser voxels, m: 2, 4, 8 ... times those of the map")
        ->check(isNumber(strict_files::above(0)));
    app.add_option("--half-lives", halfLives,
                   "Class table (YAML) with half-lives for the map's classes")
        ->type_name("FILE.yaml");
    app.add_option("--decay", decay, "Let this much time pass, s: classes with a half-life fade")
        ->check(isNumber(strict_files::between(0, 1e9)));
    addTilesOption(app, tiles);
    app.add_option("--like", like, "For OctoMap's files: take classes and filter from this map");
    addMemoryOption(app, memory);
  }
};

std::unique_ptr<StoredMap> load(const Cli& cli) {
  if (cli.like.empty()) return inputs::openMap(cli.in, cli.tiles ? cli.memory / 2 : cli.memory);
  if (!inputs::isOctomaps(cli.in))
    throw std::runtime_error("--like is for OctoMap's files (.ot, .bt), not for " +
                             cli.in.string());
  const SemanticOcTree like = inputs::loadMap(cli.like);
  return std::make_unique<StoredMap>(semantic_map::importOctomapFile(cli.in, &like));
}

Eigen::AlignedBox3d boxOf(const std::array<double, 6>& v) {
  return {Eigen::Vector3d(v[0], v[1], v[2]), Eigen::Vector3d(v[3], v[4], v[5])};
}

/** How often a voxel's edge is doubled to become the edge that an option names. */
int levelsTo(double edge, double voxelSize, int highest, const std::string& option) {
  const double levels = std::log2(edge / voxelSize);
  if (!(std::fabs(levels - std::round(levels)) < 1e-6) || levels < 0 || levels > highest)
    throw std::runtime_error(option + " is " + strict_files::textOf(edge) +
                             ", expected 1, 2, 4, 8 ... " + std::to_string(1 << highest) +
                             " times the map's voxels, " + strict_files::textOf(voxelSize) + " m");
  return static_cast<int>(std::lround(levels));
}

int writeTiles(const Cli& cli, const SemanticOcTree& map) {
  constexpr int kHighest = 15;
  levelsTo(*cli.tiles, map.getResolution(), kHighest, "--tiles");
  StoredMap tiles(emptyLike(map), cli.out, {cli.memory / 2, *cli.tiles});
  copyTo(tiles.tree(), map);
  tiles.folder()->save();
  notes() << cli.out.string() << ": " << tiles.folder()->contents().tiles << " tiles\n";
  return 0;
}

SemanticOcTree aged(SemanticOcTree map, const Cli& cli) {
  if (!cli.halfLives.empty()) map.setHalfLives(semantic_types::loadClassTable(cli.halfLives));
  if (cli.decay && !map.classes().hasHalfLives())
    throw std::runtime_error("--decay: nothing in " + cli.in.string() +
                             " has a half-life; --half-lives gives them");
  if (cli.decay) map.age(*cli.decay);
  return map;
}

int run(const Cli& cli) {
  cli.tiles ? cli.outputs.checkFolder(cli.out, {MapFolder::kIndexFile})
            : cli.outputs.check({cli.out});
  const auto stored = load(cli);
  const inputs::TileProgress progress({stored.get()}, "Editing");
  std::optional<SemanticOcTree> edited;
  const auto map = [&]() -> const SemanticOcTree& { return edited ? *edited : stored->tree(); };
  try {
    if (cli.pose) edited = moved(map(), poses::poseOfNumbers(*cli.pose));
    if (cli.box) edited = cropped(map(), boxOf(*cli.box));
  } catch (const std::logic_error& e) {
    throw std::runtime_error(cli.in.string() + ": " + e.what());
  }
  if (cli.resolution)
    edited = coarsened(map(), levelsTo(*cli.resolution, map().getResolution(), 8, "--resolution"));
  if (!cli.halfLives.empty() || cli.decay) edited = aged(edited ? *std::move(edited) : map(), cli);
  if (cli.tiles) return writeTiles(cli, map());
  saveTree(map(), cli.out.string());
  notes() << cli.out.string() << ": " << map().getNumLeafNodes() << " leaves\n";
  return 0;
}

}  // namespace
}  // namespace semantic_map_edit

int main(int argc, char** argv) {
  CLI::App app(
      "Moves, crops, coarsens, ages a semantic octree map, cuts it into tiles, in this order; "
      "imports OctoMap's");
  const semantic_map_edit::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_edit::run(cli); });
}
