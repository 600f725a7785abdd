#include "Layer.h"

#include <strict_files/Words.h>

#include <algorithm>
#include <array>

#include "inputs/Inputs.h"

namespace map_window {

namespace fs = std::filesystem;
using semantic_octree::MapFolder;
using semantic_octree::SemanticOcTree;

namespace {

SemanticOcTree openFolder(const fs::path& folder, const WantedTiles& wanted) {
  semantic_octree::MapFolderOptions options;
  options.memory = wanted.memory;
  options.wanted = [&](const Eigen::AlignedBox3d& cube) { return cube.intersects(wanted.box); };
  SemanticOcTree map = MapFolder::emptyMap(folder);
  auto tiles = std::make_unique<MapFolder>(map, folder, MapFolder::Access::Read, options);
  try {
    tiles->checkFits(std::size_t(wanted.memory * 1e6));
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(strict_files::messageOf(e) + ": --clip shows a part");
  }
  tiles->bringAll();
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
      m_own(std::make_unique<SemanticOcTree>(MapFolder::isAt(file) ? openFolder(file, wanted)
                                                                   : inputs::loadMap(file))),
      m_map(m_own.get()),
      m_look(*m_map),
      m_cells(*m_map) {
  count();
}

Layer::Layer(const std::string& name, const SemanticOcTree& map)
    : m_name(name), m_map(&map), m_look(map), m_cells(map) {
  count();
}

void Layer::grown() {
  m_look.forget();
  count();
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
