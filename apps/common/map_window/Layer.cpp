#include "Layer.h"

#include <map_operations/MapOperations.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <array>

#include "inputs/Inputs.h"

namespace map_window {

namespace fs = std::filesystem;
using semantic_octree::kTreeDepth;
using semantic_octree::MapFolder;
using semantic_octree::SemanticOcTree;

namespace {

constexpr int kMostLevels = 8;
/** The share of the budget for tiles while a coarser map is made of them. */
constexpr double kShareOfTiles = 0.25;
/** Bytes of a leaf, as in maps of streets. */
constexpr std::size_t kBytesOfLeaf = 6;

/** Levels to leave out so that the map probably fits. */
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

/** \param note is set to what there is to say of it */
SemanticOcTree openFolder(const fs::path& folder, const WantedTiles& wanted, std::string& note) {
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
    note = strict_files::messageOf(tooLarge) + ": shown with voxels of " +
           strict_files::textOf(coarse.getResolution()) + " m";
    return coarse;
  }
  tiles.reset();
  return map;
}

/** The name of a file or of a folder. */
std::string nameOf(const std::filesystem::path& file) {
  return (file.has_filename() ? file : file.parent_path()).filename().string();
}

/** Without the first and last of 500. */
std::pair<float, float> mostOf(std::vector<float>& values) {
  const std::size_t few = values.size() / 500;
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(few), values.end());
  const float low = values[few];
  std::nth_element(values.begin(), values.end() - 1 - std::ptrdiff_t(few), values.end());
  return {low, values[values.size() - 1 - few]};
}

}  // namespace

Layer::Layer(const std::filesystem::path& file, const WantedTiles& wanted)
    : m_name(nameOf(file)),
      m_own(std::make_unique<SemanticOcTree>(
          MapFolder::isAt(file) ? openFolder(file, wanted, m_note) : inputs::loadMap(file))),
      m_map(m_own.get()),
      m_look(*m_map),
      m_cells(std::make_unique<map_view::FullCells>(*m_map)) {
  count();
}

Layer::Layer(const std::string& name, const SemanticOcTree& map)
    : m_name(name), m_map(&map), m_look(map), m_cells(std::make_unique<map_view::FullCells>(map)) {
  count();
}

void Layer::grown() {
  m_look.forget();
  count();
}

void Layer::showCompressed(const map_view::LiveCompression* compression) {
  if (compression)
    m_cells = std::make_unique<map_view::CompressedCells>(*m_map, *compression);
  else
    m_cells = std::make_unique<map_view::FullCells>(*m_map);
  m_look.setCompression(compression);
}

void Layer::count() {
  m_leavesOfClass.assign(std::size_t(m_map->numClasses()) + 1, 0);
  std::array<std::vector<float>, 3> places;
  map_view::forEachOccupiedLeaf(*m_map, [&](const map_view::ViewCell& leaf) {
    ++m_leavesOfClass[m_look.classOf(leaf)];
    for (int axis = 0; axis < 3; ++axis)
      places[std::size_t(axis)].push_back(
          float(semantic_octree::centerOf(leaf.lowest[axis], m_map->getResolution(), leaf.depth)));
  });
  m_extent = Eigen::AlignedBox3d(Eigen::Vector3d::Constant(-10), Eigen::Vector3d::Constant(10));
  if (places[0].empty()) return;
  Eigen::Vector3d low, high;
  for (int axis = 0; axis < 3; ++axis)
    std::tie(low[axis], high[axis]) = mostOf(places[std::size_t(axis)]);
  m_extent = Eigen::AlignedBox3d(low, high);
}

}  // namespace map_window
