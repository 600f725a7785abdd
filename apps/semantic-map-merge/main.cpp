// Adds up semantic octree maps.
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <semantic_octree/TreeFile.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <optional>

#include "Application.h"
#include "inputs/Inputs.h"

namespace semantic_map_merge {
namespace {

namespace fs = std::filesystem;
using semantic_octree::Limits;
using semantic_octree::SemanticOcTree;
using semantic_octree::StoredMap;

struct Cli {
  std::vector<fs::path> maps;
  fs::path out;
  bool partial = false;
  std::optional<std::array<double, 6>> box;
  std::optional<double> tiles;
  double memory = semantic_octree::MapFolderOptions().memory;
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    app.add_option("MAP", maps, std::string("Maps: ") + inputs::kMap)->required();
    outputs.add(app, out, "FILE|FOLDER", "The sum to write (.semantic); with --tiles, its folder")
        ->required();
    app.add_flag("--partial", partial,
                 "The sum is a part, to be added to others: do not clamp its probabilities yet");
    app.add_option("--box", box,
                   "Add up only what is in this box, m; `inf` and `-inf` are no limit")
        ->type_name("X,Y,Z,X2,Y2,Z2")
        ->delimiter(',');
    addTilesOption(app, tiles);
    addMemoryOption(app, memory);
  }
  /** The memory of each of the maps, MB. */
  double memoryOfMap() const {
    return memory / static_cast<double>(maps.size() + tiles.has_value());
  }
};

SemanticOcTree inBox(const SemanticOcTree& map, const std::array<double, 6>& v) {
  return cropped(map, {Eigen::Vector3d(v[0], v[1], v[2]), Eigen::Vector3d(v[3], v[4], v[5])});
}

/** Adds the map of a file; with a box, what is in it. */
void load(const Cli& cli, const fs::path& file, std::deque<StoredMap>& maps) {
  if (cli.box) {
    const auto stored = inputs::openMap(file, cli.memoryOfMap());
    const inputs::TileProgress progress({stored.get()}, "Reading " + file.filename().string());
    maps.emplace_back(inBox(stored->tree(), *cli.box));
  } else {
    inputs::appendMap(maps, file, cli.memoryOfMap());
  }
  notes() << file.string() << ": " << maps.back().tree().getNumLeafNodes() << " leaves\n";
}

/** What to say of voxels that differ, with the command that makes them alike if there is one. */
std::string voxelsOf(const fs::path& first, const SemanticOcTree& a, const fs::path& second,
                     const SemanticOcTree& b) {
  using strict_files::textOf;
  const double one = a.getResolution(), other = b.getResolution();
  const std::string text = "voxels: " + textOf(one) + " m and " + textOf(other) + " m";
  const double doublings = std::log2(one / other);
  if (std::abs(doublings - std::round(doublings)) > 1e-6) return text;
  return text + "; semantic-map-edit " + (one < other ? first : second).string() +
         " --resolution " + textOf(std::max(one, other)) + " -o coarse.semantic makes them alike";
}

void checkAlike(const fs::path& first, const SemanticOcTree& a, const fs::path& second,
                const SemanticOcTree& b) {
  const auto differ = [&](const std::string& what) {
    throw std::runtime_error(first.string() + " and " + second.string() + " have different " +
                             what);
  };
  if (a.getResolution() != b.getResolution()) differ(voxelsOf(first, a, second, b));
  if (a.classes() != b.classes()) differ("classes");
  if (!(a.filterParameters() == b.filterParameters())) differ("filter parameters");
}

/** Into memory and a file, or into a folder. */
void writeSum(const Cli& cli, std::deque<StoredMap>& stored) {
  std::vector<StoredMap*> parts;
  std::vector<const SemanticOcTree*> maps;
  for (StoredMap& map : stored) {
    parts.push_back(&map);
    maps.push_back(&map.tree());
  }
  const inputs::TileProgress progress(parts, "Adding up");
  const Limits limits = cli.partial ? Limits::Keep : Limits::Apply;
  if (cli.tiles) {
    StoredMap sum(emptyLike(*maps.front()), cli.out, {cli.memoryOfMap(), *cli.tiles});
    mergeTo(sum.tree(), maps, limits);
    sum.folder()->save();
    notes() << cli.out.string() << ": " << sum.tree().getNumLeafNodes() << " leaves in "
            << sum.folder()->contents().tiles << " tiles\n";
    return;
  }
  SemanticOcTree sum = merged(maps, limits);
  saveTree(sum, cli.out.string());
  notes() << cli.out.string() << ": " << sum.getNumLeafNodes() << " leaves\n";
}

int run(const Cli& cli) {
  inputs::checkOnce(cli.maps);
  cli.tiles ? cli.outputs.checkFolder(cli.out, {semantic_octree::MapFolder::kIndexFile})
            : cli.outputs.check({cli.out});
  std::deque<StoredMap> maps;
  for (const fs::path& file : cli.maps) {
    load(cli, file, maps);
    checkAlike(cli.maps.front(), maps.front().tree(), file, maps.back().tree());
  }
  writeSum(cli, maps);
  return 0;
}

}  // namespace
}  // namespace semantic_map_merge

int main(int argc, char** argv) {
  CLI::App app("Adds up semantic octree maps");
  const semantic_map_merge::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_merge::run(cli); });
}
