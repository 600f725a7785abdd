#include "TileIndex.h"

#include <map_folders/MapFolder.h>
#include <semantic_octree/store/TileCodes.h>
#include <strict_files/StrictYaml.h>
#include <strict_files/TextFile.h>

#include <cmath>
#include <regex>
#include <sstream>

namespace semantic_octree {

using strict_files::StrictYaml;

namespace {

/** As short as reads back to the last bit. */
std::string shortest(double number) {
  for (int digits = 6;; ++digits) {
    std::ostringstream text;
    text.precision(digits);
    text << number;
    if (digits == 17 || std::stod(text.str()) == number) return text.str();
  }
}

class IndexReader {
 public:
  explicit IndexReader(const std::filesystem::path& file) : m_yaml(file) {}

  TileIndex read() const {
    const YAML::Node& root = m_yaml.root();
    m_yaml.checkKeys(root, {"version", "frame", "resolution", "tile_size", "generation", "classes",
                            "tiles", "leaves"});
    if (get<int>(root, "version", 1, 1 << 30) != TileIndex::kVersion)
      m_yaml.fail(root["version"], "version of the format, expected 1");
    TileIndex index;
    index.frame = m_yaml.text(m_yaml.required(root, "frame"), "frame");
    index.resolution = m_yaml.number(m_yaml.required(root, "resolution"), "resolution");
    index.generation = get<std::uint64_t>(root, "generation", 1, kMost);
    const YAML::Node size = m_yaml.required(root, "tile_size");
    try {
      index.depth = depthOfTiles(m_yaml.number(size, "tile_size"), index.resolution);
    } catch (const std::invalid_argument& e) {
      m_yaml.fail(size, e.what());
    }
    const YAML::Node classes = m_yaml.required(root, "classes");
    m_yaml.checkList(classes, "classes");
    for (const auto& name : classes) index.classes.push_back(m_yaml.text(name, "classes"));
    readTiles(m_yaml.required(root, "tiles"), index);
    return index;
  }

 private:
  static constexpr std::uint64_t kMost = std::uint64_t(1) << 53;

  template <typename T>
  T get(const YAML::Node& map, const char* key, T low, T high) const {
    const YAML::Node node = m_yaml.required(map, key);
    const T value = m_yaml.value<T>(node, "a whole number");
    if (value < low || value > high) m_yaml.fail(node, std::string(key) + " is out of range");
    return value;
  }

  void readTiles(const YAML::Node& tiles, TileIndex& index) const {
    if (!tiles.IsSequence()) m_yaml.fail(tiles, "tiles: expected a list");
    std::set<std::uint64_t> codes;
    for (const auto& node : tiles) {
      m_yaml.checkKeys(node, {"at", "generation", "nodes", "inner", "highest"});
      TileIndex::Tile tile;
      tile.place = placeOf(m_yaml.required(node, "at"), index.depth);
      tile.generation = get<std::uint64_t>(node, "generation", 1, index.generation);
      tile.nodes = get<long>(node, "nodes", 1, mostNodes(index.depth));
      tile.innerNodes = get<long>(node, "inner", 0, tile.nodes);
      tile.highest = static_cast<Units>(get<int>(node, "highest", kUnknown + 1, INT16_MAX));
      if (!codes.insert(tileCode(tile.place)).second) m_yaml.fail(node, "a tile twice");
      index.tiles.push_back(tile);
    }
  }

  /** Below a tile's own. */
  static long mostNodes(int depth) {
    long most = 0;
    for (; depth < kTreeDepth; ++depth) most = 8 * (most + 1);
    return most;
  }

  VoxelIndex placeOf(const YAML::Node& node, int depth) const {
    const Eigen::Array3d fromOrigin = m_yaml.point(node, "at");
    const int half = 1 << (depth - 1);
    if (!(fromOrigin == fromOrigin.round()).all() || !(fromOrigin >= -half).all() ||
        !(fromOrigin < half).all())
      m_yaml.fail(node, "at: expected three whole numbers within the map");
    return fromOrigin.cast<int>() + half;
  }

  StrictYaml m_yaml;
};

}  // namespace

std::string TileIndex::nameOf(const VoxelIndex& place, std::uint64_t ofGeneration) const {
  const VoxelIndex at = place - (1 << (depth - 1));
  std::ostringstream name;
  name << "tile_" << at.x() << '_' << at.y() << '_' << at.z() << '.' << ofGeneration << ".semantic";
  return name.str();
}

std::string TileIndex::leavesName(std::uint64_t ofGeneration) {
  return "leaves." + std::to_string(ofGeneration) + ".semantic";
}

bool TileIndex::isName(const std::string& name) {
  static const std::regex pattern("(tile_-?[0-9]+_-?[0-9]+_-?[0-9]+|leaves)\\.[0-9]+\\.semantic");
  return std::regex_match(name, pattern);
}

int depthOfTiles(double tileSize, double resolution) {
  const double levels = std::floor(std::log2(tileSize / resolution * (1 + 1e-9)));
  if (!(levels >= kTreeDepth - kTileDepth) || !(levels < kTreeDepth))
    throw std::invalid_argument("tile_size = " + std::to_string(tileSize) +
                                " m, expected 8 to 32768 times the resolution");
  return kTreeDepth - static_cast<int>(levels);
}

TileIndex readIndex(const std::filesystem::path& folder) {
  return IndexReader(folder / MapFolder::kIndexFile).read();
}

void writeIndex(const std::filesystem::path& folder, const TileIndex& index) {
  YAML::Emitter classes;
  classes << YAML::Flow << index.classes;
  YAML::Emitter frame;
  frame << index.frame;
  std::ostringstream text;
  text << "# A map in tiles: tile_X_Y_Z.GENERATION.semantic is what lies in the cube from\n"
       << "# (X, Y, Z) to (X + 1, Y + 1, Z + 1) times tile_size. Lower borders belong to it.\n"
       << "version: " << TileIndex::kVersion << "\nframe: " << frame.c_str()
       << "\nresolution: " << shortest(index.resolution)
       << "\ntile_size: " << shortest(index.tileSize()) << "\ngeneration: " << index.generation
       << "\nclasses: " << classes.c_str() << "\ntiles:";
  if (index.tiles.empty()) text << " []";
  text << '\n';
  const int half = 1 << (index.depth - 1);
  for (const TileIndex::Tile& tile : index.tiles) {
    const VoxelIndex at = tile.place - half;
    text << "  - {at: [" << at.x() << ", " << at.y() << ", " << at.z()
         << "], generation: " << tile.generation << ", nodes: " << tile.nodes
         << ", inner: " << tile.innerNodes << ", highest: " << tile.highest << "}\n";
  }
  text << "leaves:";
  if (index.leaves.empty()) text << " []";
  text << '\n';
  for (const Cell& leaf : index.leaves) {
    const int tiles = 1 << (index.depth - leaf.depth);
    const VoxelIndex at = leaf.index * tiles - half;
    text << "  - {at: [" << at.x() << ", " << at.y() << ", " << at.z() << "], tiles: " << tiles
         << "}\n";
  }
  strict_files::writeText(folder / MapFolder::kIndexFile, text.str());
}

}  // namespace semantic_octree
