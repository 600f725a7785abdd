#pragma once
#include <semantic_octree/store/HitVotes.h>
#include <semantic_octree/store/NodeStore.h>
#include <semantic_octree/store/ScanGrid.h>
#include <semantic_octree/store/TileCodes.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

namespace semantic_octree {

/** Voxels of a scan in which something ended: tiles of bits as in ScanGrid, but only those that
 * have any. Tiles are known by their number (see ScanGrid::numberOf()), voxels by their place. */
class HitTiles {
 public:
  struct Tile {
    VoxelBits words[ScanGrid::kWords];  ///< a block each
    /** Each word's first voxel has this rank among all; the others follow in Morton order. */
    std::uint32_t ranks[ScanGrid::kWords];
  };

  /** Forgets all voxels. */
  void cover(std::size_t numTiles);

  /** Adds a voxel. \return whether it was there before */
  bool testAndSet(const ScanGrid::Place& voxel);
  /** Adds a tile's voxels; it has none yet. */
  void add(std::size_t tile, const VoxelBits* words) {
    m_indices[tile] = static_cast<std::uint32_t>(m_tiles.size());
    std::copy_n(words, ScanGrid::kWords, m_tiles.emplace_back().words);
  }
  /** Ranks voxels. \return their number */
  std::uint32_t rank();

  bool has(std::size_t tile) const { return m_indices[tile] != 0; }
  /** Without bits if nothing ended there. */
  const Tile& tile(std::size_t number) const { return m_tiles[m_indices[number]]; }
  std::uint32_t rankOf(const ScanGrid::Place& voxel) const {
    const Tile& t = tile(voxel.tile);
    const unsigned word = voxel.bit >> 6;
    const VoxelBits below = (VoxelBits(1) << (voxel.bit & 63)) - 1;
    return t.ranks[word] + static_cast<std::uint32_t>(countOf(t.words[word] & below));
  }

 private:
  std::vector<std::uint32_t> m_indices;  ///< among m_tiles
  std::vector<Tile> m_tiles;             ///< the first one is empty
};

inline bool HitTiles::testAndSet(const ScanGrid::Place& voxel) {
  std::uint32_t& index = m_indices[voxel.tile];
  if (index == 0) {
    index = static_cast<std::uint32_t>(m_tiles.size());
    m_tiles.emplace_back();
  }
  VoxelBits& word = m_tiles[index].words[voxel.bit >> 6];
  const VoxelBits mask = VoxelBits(1) << (voxel.bit & 63);
  const bool before = word & mask;
  word |= mask;
  return before;
}

/** What a cube of space holds of a scan. */
struct CubeContent {
  static constexpr std::uint8_t kAny = 1, kHit = 2, kNotAllFree = 4;
  std::uint8_t flags = 0;
  bool any() const { return flags & kAny; }
  bool hit() const { return flags & kHit; }
  /** Every voxel was seen free, none was hit. */
  bool allFree() const { return flags == kAny; }
  /** Joins what a part of the cube holds. */
  void add(CubeContent part) { flags |= part.any() ? part.flags : kNotAllFree; }
};

/** Summary of a scan's tiles at every level of the tree above them. Level 0 are the tiles, level 13
 * is the whole map. A cube of level l has a side of 8 * 2^l voxels. */
class ScanPyramid {
 public:
  static constexpr int kTopLevel = 13;

  /** Starts anew for the tiles of this grid: nothing seen. */
  void cover(const ScanGrid& grid);
  /** \param tile its number in the grid */
  void set(std::size_t tile, CubeContent content) { m_levels[0].cubes[tile] = content; }
  CubeContent tile(std::size_t tile) const { return m_levels[0].cubes[tile]; }
  /** Fills the levels above the tiles. */
  void build();

  /** Cube at absolute coordinates (key / (8 * 2^level)); nothing outside the grid. */
  CubeContent at(int level, const VoxelIndex& cube) const {
    const Level& l = m_levels[level];
    const VoxelIndex i = cube - l.first;
    if ((i < 0).any() || (i >= l.size).any()) return {};
    return l.cubes[l.indexOf(i)];
  }

 private:
  struct Level {
    VoxelIndex first, size;
    std::vector<CubeContent> cubes;
    std::size_t indexOf(const VoxelIndex& i) const {
      return (std::size_t(i.z()) * size.y() + i.y()) * size.x() + i.x();
    }
  };
  void buildLevel(int level);

  Level m_levels[kTopLevel + 1];
};

/** One scan turned into voxels: which were seen free, which were hit and with what class. Its
 * buffers are reused from scan to scan; their size is bounded by the box that the scan's beams
 * cross. */
class Scan {
 public:
  /** Replaces the content by this cloud's.
   * \param filter the map's
   * \throw std::out_of_range the sensor is outside the map
   * \throw std::invalid_argument sizes of the cloud's vectors do not match, or a class above K. */
  void set(const semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
           double resolution, const ClassFilter& filter, const InsertionOptions& options);

  /** Replaces the content by what will come: tiles in a box, which is not empty, one by one
   * (addTile()), then finish(). \param labels how far they are trusted \param options its memory's
   * limit \throw std::length_error it is too small. */
  void begin(const TileBox& box, const LabelReliability& labels, int numClasses,
             const InsertionOptions& options);
  /** \param tile key of a voxel in it / 8 \param free, hit a word for each block. What the hit
   * voxels' labels say is to be added to votes(), voxel by voxel. */
  void addTile(const VoxelIndex& tile, const VoxelBits* free, const VoxelBits* hit);
  HitVotes& votes() { return m_votes; }
  void finish();
  /** Forgets all. */
  void reset() { m_report = InsertionReport(); }

  const InsertionReport& report() const { return m_report; }
  const ScanPyramid& pyramid() const { return m_pyramid; }
  const HitVotes& votes() const { return m_votes; }
  /** How far the whole scan's labels are trusted; a part of it has its whole's. */
  const LabelReliability& labels() const { return m_report.labels; }

  struct Tile {
    const VoxelBits* free;      ///< a word for each block, in Morton order as their bits
    const HitTiles::Tile& hit;  ///< ranks are those of HitVotes
  };
  /** \param tile key of a voxel in it / 8 */
  Tile tile(const VoxelIndex& tile) const;
  /** Tiles in which anything was seen; none if there are no voxels. */
  std::vector<VoxelIndex> tiles() const;
  bool hasVoxels() const { return report().hitVoxels + report().freeVoxels > 0; }
  /** Forgets the voxels, keeps the buffers. */
  void clear();
  /** Whether the buffers are too large to be kept for the next scan. */
  bool isLarge() const;

 private:
  /** Tiles whose bits, and what is noted of them, fit into InsertionOptions::maxScanMemory. */
  static std::size_t maxTiles(const InsertionOptions& options);
  void markHits(const InsertionOptions& options);
  void markFree(const InsertionOptions& options, double margin);
  /** Follows some beams, and notes in which voxels they end. */
  void markFreePart(std::size_t first, ScanGrid& grid, const InsertionOptions& options,
                    double margin);
  /** \param beside what another thread may do meanwhile, which does not touch tiles' bits */
  void summarize(const std::function<void()>& beside);
  /** \return the voxels of a row of tiles that were seen free */
  std::size_t summarizeRow(std::size_t row);
  CubeContent summarizeTile(const VoxelIndex& tile, std::size_t number, std::size_t& freeVoxels);
  ScanGrid::Place placeOf(const Beam& beam) const {
    return m_free[0].placeOf(ScanBeams::voxelOf(beam.end) - m_free[0].firstVoxel());
  }

  InsertionReport m_report;
  ScanBeams m_beams;
  std::vector<ScanGrid> m_free;  ///< one per thread, united in the first
  HitTiles m_hits;
  HitTiles m_clippedEnds;      ///< of beams beyond the range, to carve each end voxel once
  std::vector<bool> m_carves;  ///< per point: whether its beam carves; empty: all do
  std::vector<std::uint32_t> m_endRanks;  ///< per point: rank of the voxel that it hit
  ScanPyramid m_pyramid;
  HitVotes m_votes;
};

}  // namespace semantic_octree
