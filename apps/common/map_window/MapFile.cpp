#include "MapFile.h"

#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_map/MapFiles.h>
#include <strict_files/Words.h>

#include <array>

namespace map_window {

namespace fs = std::filesystem;
using semantic_octree::kTreeDepth;
using semantic_octree::MapFolder;
using semantic_octree::SemanticOcTree;

namespace {

constexpr int kMostLevels = 8;
/** The share of the budget for tiles while a coarser map is made of them. */
constexpr double kShareOfTiles = 0.25;
/** As maps of streets have them. */
constexpr std::size_t kBytesOfLeaf = 6;

/** So many levels less that the map will probably fit. */
int levelsFor(const SemanticOcTree& map, std::size_t bytes) {
  std::array<std::size_t, kTreeDepth + 1> nodes{}, leaves{};
  for (auto node = map.begin_tree(kTreeDepth - 1); node != map.end_tree(); ++node) {
    ++nodes[node.getDepth()];
    leaves[node.getDepth()] += (*node).isLeaf();
  }
  for (int levels = 1; levels < kMostLevels; ++levels) {
    const std::size_t depth = std::size_t(kTreeDepth - levels);
    std::size_t number = nodes[depth];
    for (std::size_t d = 0; d < depth; ++d) number += leaves[d];
    if (number * kBytesOfLeaf <= bytes) return levels;
  }
  return kMostLevels;
}

SemanticOcTree coarseEnough(const SemanticOcTree& map, std::size_t bytes) {
  for (int levels = levelsFor(map, bytes);; ++levels) {
    SemanticOcTree coarse = semantic_octree::coarsened(map, levels);
    if (levels == kMostLevels || coarse.memoryUsage() <= bytes) return coarse;
  }
}

OpenedMap openFolder(const fs::path& folder, const WantedTiles& wanted) {
  const double bytes = wanted.memory * 1e6;
  semantic_octree::MapFolderOptions options;
  options.memory = kShareOfTiles * wanted.memory;
  options.wanted = [&](const Eigen::AlignedBox3d& cube) { return cube.intersects(wanted.box); };
  SemanticOcTree map = MapFolder::emptyMap(folder);
  auto tiles = std::make_unique<MapFolder>(map, folder, MapFolder::Access::Read, options);
  try {
    tiles->bringAll(std::size_t(bytes));
  } catch (const std::runtime_error& tooLarge) {
    SemanticOcTree coarse = coarseEnough(map, std::size_t((1 - kShareOfTiles) * bytes));
    const std::string edge = strict_files::textOf(coarse.getResolution());
    return {std::move(coarse),
            strict_files::messageOf(tooLarge) + ": shown with voxels of " + edge + " m"};
  }
  tiles.reset();
  return {std::move(map), {}};
}

}  // namespace

OpenedMap openMap(const fs::path& file, const WantedTiles& wanted) {
  if (MapFolder::isAt(file)) return openFolder(file, wanted);
  if (file.extension() != ".ot" && file.extension() != ".bt")
    return {semantic_octree::loadMap(file.string()), {}};
  return {semantic_octree::fromOcTree(*semantic_map::readOctomapFile(file),
                                      semantic_map::CSemanticOctoMap::occupancyOnly()),
          {}};
}

}  // namespace map_window
