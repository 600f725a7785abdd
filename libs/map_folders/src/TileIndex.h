#pragma once
#include <semantic_octree/store/Cell.h>
#include <semantic_octree/store/ClassRecord.h>

#include <filesystem>
#include <string>
#include <vector>

namespace semantic_octree {

/** What a map folder's index.yaml says. */
struct TileIndex {
  struct Tile {
    VoxelIndex place;                ///< index of its cell
    std::uint64_t generation = 0;    ///< when its file was written
    long nodes = 0, innerNodes = 0;  ///< below its own
    Units highest = 0;               ///< log-odds of the most occupied leaf in it
  };
  double resolution = 0;  ///< meters
  int depth = 0;          ///< of tiles
  std::string frame = "map";
  std::vector<std::string> classes;  ///< names, to be read; leaves.*.semantic has all of them
  /** Counts what was saved. Files of others are left from what was not. */
  std::uint64_t generation = 0;
  std::vector<Tile> tiles;
  /** As large as tiles, or larger: written, for others, and not read. */
  std::vector<Cell> leaves;

  /** Edge of a tile, meters. */
  double tileSize() const { return resolution * edgeAtDepth(depth); }
  /** A tile's file: its place, in tiles from the map's origin, and generation. */
  std::string nameOf(const VoxelIndex& place, std::uint64_t generation) const;
  /** The file of leaves that are as large as tiles, or larger. */
  static std::string leavesName(std::uint64_t generation);
  /** Whether one of these may be a file's name. */
  static bool isName(const std::string& name);

  static constexpr int kVersion = 1;
};

/** Depth of cubes with this edge, meters, or with the largest power of two times the resolution
 * that is below. \throw std::invalid_argument they would have less than 8 voxels, or be the map. */
int depthOfTiles(double tileSize, double resolution);

/** \throw std::runtime_error naming the file, line and what is wrong. */
TileIndex readIndex(const std::filesystem::path& folder);
/** \throw std::runtime_error naming the file; what was there stays. */
void writeIndex(const std::filesystem::path& folder, const TileIndex& index);

}  // namespace semantic_octree
