// Adds semantic octree maps up.
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_octree/MapFolder.h>
#include <semantic_octree/MapOperations.h>
#include <semantic_octree/TreeFile.h>

#include <deque>
#include <ostream>

#include "Application.h"
#include "MapPoses.h"
#include "MemoryOption.h"
#include "Outputs.h"
#include "StandardOutput.h"

namespace semantic_map_merge {
namespace {

namespace fs = std::filesystem;
using semantic_map::CSemanticOctoMap;
using semantic_octree::Limits;
using semantic_octree::SemanticOcTree;
using semantic_octree::StoredMap;

struct Cli {
  std::vector<fs::path> maps;
  fs::path out, poses;
  bool partial = false;
  double memory = semantic_octree::MapFolderOptions().memory;
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    app.add_option("MAP", maps, "Maps' own files (.semantic), or folders of tiles")->required();
    outputs.add(app, out, "FILE", "The sum to write (.semantic)")->required();
    app.add_option("--poses", poses, "File of lines `MAP x y z yaw pitch roll` (m, degrees)");
    app.add_flag("--partial", partial,
                 "The sum will be added to others: do not limit yet how sure it is");
    addMemoryOption(app, memory);
  }
};

/** Adds the map of a file, moved if it has a pose. */
void load(const Cli& cli, const fs::path& file, const std::map<fs::path, Eigen::Isometry3d>& poses,
          std::deque<StoredMap>& maps) {
  const auto pose = poses.find(file);
  const double memory = cli.memory / static_cast<double>(cli.maps.size());
  if (pose != poses.end())
    maps.emplace_back(moved(StoredMap(file, memory).tree(), pose->second));
  else
    maps.emplace_back(file, memory);
  notes() << file.string() << ": " << maps.back().tree().getNumLeafNodes() << " leaves\n";
}

void checkAlike(const fs::path& first, const SemanticOcTree& a, const fs::path& second,
                const SemanticOcTree& b) {
  const auto differ = [&](const std::string& what) {
    throw std::runtime_error(first.string() + " and " + second.string() + " have different " +
                             what);
  };
  if (a.getResolution() != b.getResolution()) differ("resolutions");
  if (a.classes() != b.classes()) differ("classes");
  if (!(a.filterParameters() == b.filterParameters())) differ("filter parameters");
}

int run(const Cli& cli) {
  cli.outputs.check({cli.out});
  std::map<fs::path, Eigen::Isometry3d> poses;
  if (!cli.poses.empty()) poses = readMapPoses(cli.poses, cli.maps);
  std::deque<StoredMap> maps;
  std::vector<const SemanticOcTree*> pointers;
  for (const fs::path& file : cli.maps) {
    load(cli, file, poses, maps);
    checkAlike(cli.maps.front(), maps.front().tree(), file, maps.back().tree());
    pointers.push_back(&maps.back().tree());
  }
  SemanticOcTree sum = merged(pointers, cli.partial ? Limits::Keep : Limits::Apply);
  saveTree(sum, cli.out.string());
  notes() << cli.out.string() << ": " << CSemanticOctoMap(std::move(sum)).asString() << '\n';
  return 0;
}

}  // namespace
}  // namespace semantic_map_merge

int main(int argc, char** argv) {
  CLI::App app("Adds semantic octree maps up");
  const semantic_map_merge::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_merge::run(cli); });
}
