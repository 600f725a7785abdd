#include "TileIndex.h"

#include <map_folders/MapFolder.h>
#include <semantic_octree/store/TileCodes.h>
#include <semantic_octree/store/TreeFormat.h>
#include <strict_files/StrictYaml.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <sstream>

namespace semantic_octree {

namespace fs = std::filesystem;
using strict_files::StrictYaml;
using strict_files::textOf;

namespace {

constexpr const char* kChecksumKey = "checksum: ";

/** The last line, for all that is before it. */
std::string checksumLine(const std::string& text) {
  return kChecksumKey + std::to_string(extendCrc(0, text.data(), text.size())) + '\n';
}

/** \throw std::runtime_error naming the file: cut off or altered */
std::string verified(const std::string& text, const fs::path& file) {
  const std::size_t last = text.rfind(std::string("\n") + kChecksumKey);
  const std::string covered = last == std::string::npos ? text : text.substr(0, last + 1);
  if (covered + checksumLine(covered) != text)
    throw std::runtime_error(file.string() + ": cut off or altered: it does not end with '" +
                             strict_files::trimmed(checksumLine(covered)) + "'");
  return text;
}

class IndexReader {
 public:
  explicit IndexReader(const fs::path& file)
      : m_yaml(verified(strict_files::readText(file), file), file.string()) {}

  TileIndex read() {
    const YAML::Node& root = m_yaml.root();
    m_yaml.checkKeys(root, {"version", "frame", "resolution", "tile_size", "generation", "classes",
                            "tiles", "leaves", "leaves_checksum", "old", "checksum"});
    if (get<int>(root, "version", 1, 1 << 30) != TileIndex::kVersion)
      m_yaml.fail(root["version"], "version of the format, expected 2");
    TileIndex index;
    index.frame = m_yaml.text(m_yaml.required(root, "frame"), "frame");
    index.resolution = m_yaml.number(m_yaml.required(root, "resolution"), "resolution");
    index.generation = get<std::uint64_t>(root, "generation", 1, TileIndex::kMostToRead);
    const YAML::Node size = m_yaml.required(root, "tile_size");
    try {
      index.depth = depthOfTiles(m_yaml.number(size, "tile_size"), index.resolution);
      if (index.tileSize() != m_yaml.number(size, "tile_size"))
        m_yaml.fail(size, "tile_size: expected " + textOf(index.tileSize()));
    } catch (const std::invalid_argument& e) {
      m_yaml.fail(size, e.what());
    }
    const YAML::Node classes = m_yaml.required(root, "classes");
    m_yaml.checkList(classes, "classes");
    for (const auto& name : classes) index.classes.push_back(m_yaml.text(name, "classes"));
    for (const auto& node : list(root, "tiles")) index.tiles.push_back(tile(node, index));
    for (const auto& node : list(root, "leaves")) index.leaves.push_back(leaf(node, index.depth));
    index.leavesChecksum = checksum(root, "leaves_checksum");
    const std::set<std::string> files = index.files();
    for (const auto& node : list(root, "old")) index.old.push_back(oldName(node, files));
    return index;
  }

 private:
  template <typename T>
  T get(const YAML::Node& map, const char* key, T low, T high) const {
    const YAML::Node node = m_yaml.required(map, key);
    const T value = m_yaml.value<T>(node, "a whole number");
    if (value < low || value > high) m_yaml.fail(node, std::string(key) + " is out of range");
    return value;
  }

  YAML::Node list(const YAML::Node& root, const char* key) const {
    const YAML::Node list = m_yaml.required(root, key);
    if (!list.IsSequence()) m_yaml.fail(list, std::string(key) + ": expected a list");
    return list;
  }

  std::uint32_t checksum(const YAML::Node& map, const char* key) const {
    return get<std::uint32_t>(map, key, 0, UINT32_MAX);
  }

  TileIndex::Tile tile(const YAML::Node& node, const TileIndex& index) {
    m_yaml.checkKeys(node, {"at", "generation", "nodes", "inner", "highest", "checksum"});
    TileIndex::Tile tile;
    tile.place = placeOf(m_yaml.required(node, "at"), index.depth);
    tile.generation = get<std::uint64_t>(node, "generation", 1, index.generation);
    tile.nodes = get<long>(node, "nodes", 1, mostNodes(index.depth));
    tile.innerNodes = get<long>(node, "inner", 0, tile.nodes);
    tile.highest = static_cast<Units>(get<int>(node, "highest", kUnknown + 1, INT16_MAX));
    tile.checksum = checksum(node, "checksum");
    if (!m_codes.insert(tileCode(tile.place)).second) m_yaml.fail(node, "a tile twice");
    return tile;
  }

  Cube leaf(const YAML::Node& node, int depth) const {
    m_yaml.checkKeys(node, {"at", "tiles"});
    const VoxelIndex place = placeOf(m_yaml.required(node, "at"), depth);
    const int tiles = get<int>(node, "tiles", 1, 1 << depth);
    const int above = static_cast<int>(std::lround(std::log2(tiles)));
    if (tiles != 1 << above || (place / tiles * tiles != place).any())
      m_yaml.fail(node, "a leaf that cannot be");
    return cubeAt(place / tiles, depth - above);
  }

  std::string oldName(const YAML::Node& node, const std::set<std::string>& needed) const {
    const std::string name = m_yaml.text(node, "old");
    if (!TileIndex::generationOf(name) || needed.count(name))
      m_yaml.fail(node, "old: expected names of tiles that the map does not need");
    return name;
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
  std::set<std::uint64_t> m_codes;  ///< of the tiles
};

}  // namespace

std::string TileIndex::nameOf(const VoxelIndex& place, std::uint64_t ofGeneration) const {
  const VoxelIndex at = place - (1 << (depth - 1));
  std::string name = "tile";
  for (const int coordinate : {at.x(), at.y(), at.z()}) name += '_' + std::to_string(coordinate);
  return name + '.' + std::to_string(ofGeneration) + ".semantic";
}

std::string TileIndex::leavesName(std::uint64_t ofGeneration) {
  return "leaves." + std::to_string(ofGeneration) + ".semantic";
}

std::optional<std::uint64_t> TileIndex::generationOf(const std::string& name) {
  constexpr std::size_t kLongest = 255;  // names of files; std::regex goes as deep as they are long
  if (name.size() > kLongest) return {};
  static const std::regex pattern("(tile_-?\\d+_-?\\d+_-?\\d+|leaves)\\.(\\d+)\\.semantic");
  std::smatch match;
  if (!std::regex_match(name, match, pattern)) return {};
  return std::strtoull(match[2].str().c_str(), nullptr, 10);
}

std::set<std::string> TileIndex::files() const {
  std::set<std::string> names = {leavesName(generation)};
  for (const Tile& tile : tiles) names.insert(nameOf(tile.place, tile.generation));
  return names;
}

void TileIndex::keepWanted(const std::function<bool(const Eigen::AlignedBox3d&)>& wanted) {
  const auto isUnwanted = [&](const Tile& tile) {
    const VoxelIndex origin = VoxelIndex::Constant(kKeyOfOrigin / edgeAtDepth(depth));
    const Eigen::Vector3d low = (tile.place - origin).matrix().cast<double>() * tileSize();
    return !wanted({low, low + Eigen::Vector3d::Constant(tileSize())});
  };
  tiles.erase(std::remove_if(tiles.begin(), tiles.end(), isUnwanted), tiles.end());
}

int depthOfTiles(double tileSize, double resolution) {
  const double levels = std::floor(std::log2(tileSize / resolution * (1 + 1e-9)));
  if (!(levels >= kTreeDepth - kTileDepth) || !(levels < kTreeDepth))
    throw std::invalid_argument("tile_size = " + textOf(tileSize) +
                                " m, expected 8 to 32768 times the resolution");
  return kTreeDepth - static_cast<int>(levels);
}

TileIndex readIndex(const fs::path& folder) {
  return IndexReader(folder / MapFolder::kIndexFile).read();
}

std::uint64_t nextGeneration(const fs::path& folder, const TileIndex& index) {
  std::uint64_t last = index.generation;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const auto found = TileIndex::generationOf(entry.path().filename().string());
    if (found && *found <= TileIndex::kMostToRead) last = std::max(last, *found);
  }
  if (last > TileIndex::kMostToWrite)
    throw std::runtime_error(folder.string() + ": a generation of " + std::to_string(last) +
                             ", expected at most " + std::to_string(TileIndex::kMostToWrite) +
                             " to write into this folder");
  return last + 1;
}

void writeIndex(const fs::path& folder, const TileIndex& index) {
  std::ostringstream text;
  const strict_files::ClassicNumbers classic(text);
  const auto begin = [&text](const char* list, bool isEmpty) {
    text << list << (isEmpty ? ": []\n" : ":\n");
  };
  const auto placeOf = [&index](const VoxelIndex& tile) {
    const VoxelIndex at = tile - (1 << (index.depth - 1));
    return "  - {at: [" +
           strict_files::joined(
               {std::to_string(at.x()), std::to_string(at.y()), std::to_string(at.z())}) +
           "], ";
  };
  YAML::Emitter classes, frame;
  classes << YAML::Flow << index.classes;
  frame << index.frame;
  text << "# A map in tiles: tile_X_Y_Z.GENERATION.semantic is what lies in the cube from\n"
       << "# (X, Y, Z) to (X + 1, Y + 1, Z + 1) times tile_size. Lower borders belong to it.\n"
       << "version: " << TileIndex::kVersion << "\nframe: " << frame.c_str()
       << "\nresolution: " << textOf(index.resolution)
       << "\ntile_size: " << textOf(index.tileSize()) << "\ngeneration: " << index.generation
       << "\nclasses: " << classes.c_str() << '\n';
  begin("tiles", index.tiles.empty());
  for (const TileIndex::Tile& tile : index.tiles)
    text << placeOf(tile.place) << "generation: " << tile.generation << ", nodes: " << tile.nodes
         << ", inner: " << tile.innerNodes << ", highest: " << tile.highest
         << ", checksum: " << tile.checksum << "}\n";
  begin("leaves", index.leaves.empty());
  for (const Cube& leaf : index.leaves) {
    const int tiles = 1 << (index.depth - leaf.depth);
    text << placeOf(indexOf(leaf) * tiles) << "tiles: " << tiles << "}\n";
  }
  text << "leaves_checksum: " << index.leavesChecksum << '\n';
  begin("old", index.old.empty());
  for (const std::string& name : index.old) text << "  - " << name << '\n';
  strict_files::writeText(folder / MapFolder::kIndexFile, text.str() + checksumLine(text.str()));
}

}  // namespace semantic_octree
