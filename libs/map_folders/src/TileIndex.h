#pragma once
#include <semantic_octree/store/ClassRecord.h>
#include <semantic_octree/store/Cubes.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace semantic_octree {

/** What a map folder's index.yaml says. Its last line is a checksum of all others. */
struct TileIndex {
  struct Tile {
    VoxelIndex place;                ///< index of its cell
    std::uint64_t generation = 0;    ///< when its file was written
    long nodes = 0, innerNodes = 0;  ///< below its own
    Units highest = 0;               ///< log-odds of the most occupied leaf in it
    std::uint32_t checksum = 0;      ///< of its file: the last one in it
  };
  double resolution = 0;  ///< meters
  int depth = 0;          ///< of tiles
  std::string frame = "map";
  std::vector<std::string> classes;  ///< names, to be read; leaves.*.semantic has all of them
  /** Number of the save; 0: nothing was saved. */
  std::uint64_t generation = 0;
  std::vector<Tile> tiles;
  /** Leaves as large as tiles, or larger. */
  std::vector<Cube> leaves;
  std::uint32_t leavesChecksum = 0;  ///< of their file
  /** Files that earlier saves needed and this does not. Nobody removes others. */
  std::vector<std::string> old;

  /** Edge of a tile, meters. */
  double tileSize() const { return resolution * edgeAtDepth(depth); }
  /** A tile's file: its place, in tiles from the map's origin, and generation. */
  std::string nameOf(const VoxelIndex& place, std::uint64_t generation) const;
  /** The file of leaves that are as large as tiles, or larger. */
  static std::string leavesName(std::uint64_t generation);
  /** The generation of a file with such a name; nothing: it has none. */
  static std::optional<std::uint64_t> generationOf(const std::string& name);
  /** Names of the map's files. */
  std::set<std::string> files() const;

  /** Tiles of other cubes (meters, map frame) go. */
  void keepWanted(const std::function<bool(const Eigen::AlignedBox3d& cube)>& wanted);

  static constexpr int kVersion = 2;
  static constexpr const char *kWriterLock = ".writer.lock", *kReadersLock = ".readers.lock";
  /** The last generation to read, and to open for writing. No process saves as often as there are
   * generations between. */
  static constexpr std::uint64_t kMostToRead = (std::uint64_t(1) << 53) - 1,
                                 kMostToWrite = std::uint64_t(1) << 52;
};

/** Depth of cubes with this edge, meters, or with the largest power of two times the resolution
 * that is below. \throw std::invalid_argument they would have less than 8 voxels, or be the map. */
int depthOfTiles(double tileSize, double resolution);

/** \throw std::runtime_error naming the file and what is wrong: of another version, cut off,
 * altered, or with a value (and its line) that cannot be. */
TileIndex readIndex(const std::filesystem::path& folder);
/** The next save's generation: above all that are in the folder, whoever left them, so that none of
 * their files is written over. \throw std::runtime_error it would be too high */
std::uint64_t nextGeneration(const std::filesystem::path& folder, const TileIndex& index);
/** \throw std::runtime_error naming the file; what was there stays. */
void writeIndex(const std::filesystem::path& folder, const TileIndex& index);

}  // namespace semantic_octree
