// Adds semantic octree maps up.
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_octree/MapOperations.h>
#include <semantic_octree/TreeFile.h>

#include <ostream>

#include "Application.h"
#include "MapPoses.h"
#include "Outputs.h"
#include "StandardOutput.h"

namespace semantic_map_merge {
namespace {

namespace fs = std::filesystem;
using semantic_map::CSemanticOctoMap;
using semantic_octree::Limits;
using semantic_octree::SemanticOcTree;

struct Cli {
  std::vector<fs::path> maps;
  fs::path out, poses;
  bool partial = false;
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    app.add_option("MAP", maps, "Maps' own files (.semantic)")->required();
    outputs.add(app, out, "FILE", "The sum to write (.semantic)")->required();
    app.add_option("--poses", poses, "File of lines `MAP x y z yaw pitch roll` (m, degrees)");
    app.add_flag("--partial", partial,
                 "The sum will be added to others: do not limit yet how sure it is");
  }
};

SemanticOcTree load(const fs::path& file, const std::map<fs::path, Eigen::Isometry3d>& poses) {
  SemanticOcTree map = semantic_octree::loadTree(file.string());
  const auto pose = poses.find(file);
  if (pose != poses.end()) map = moved(map, pose->second);
  notes() << file.string() << ": " << map.getNumLeafNodes() << " leaves\n";
  return map;
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
  std::vector<SemanticOcTree> maps;
  maps.reserve(cli.maps.size());
  std::vector<const SemanticOcTree*> pointers;
  for (const fs::path& file : cli.maps) {
    maps.push_back(load(file, poses));
    checkAlike(cli.maps.front(), maps.front(), file, maps.back());
    pointers.push_back(&maps.back());
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
