#pragma once
#include <semantic_octree/store/HitTiles.h>
#include <semantic_octree/store/HitVotes.h>
#include <semantic_octree/store/ScanBeams.h>
#include <semantic_octree/store/ScanGrid.h>
#include <semantic_octree/store/ScanPyramid.h>
#include <semantic_octree/store/TileCodes.h>

namespace semantic_octree {

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
           double resolution, const ClassFilter<float>& filter, const InsertionOptions& options);

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
  /** Those in which anything was seen; none if there are no voxels. */
  std::vector<VoxelIndex> tiles() const;
  bool hasVoxels() const { return report().hitVoxels + report().freeVoxels > 0; }
  /** Forgets the voxels, keeps the buffers. */
  void clear();
  /** Larger buffers are not kept for the next scan. */
  static constexpr std::size_t kTooManyBytes = 256000000;

  /** Bytes of the buffers. */
  std::size_t bytes() const;

 private:
  /** Tiles whose bits, and what is noted of them, fit into InsertionOptions::maxScanMemory. */
  static std::size_t maxTiles(const InsertionOptions& options);
  void markHits(const ScanBeams& beams, const InsertionOptions& options);
  void markFree(const ScanBeams& beams, const InsertionOptions& options, double margin);
  /** Follows a part's beams, and notes in which voxels they end. */
  void markFreePart(const ScanBeams& beams, int part, const InsertionOptions& options,
                    double margin);
  void summarize();
  CubeContent summarizeTile(const VoxelIndex& tile, std::size_t number);
  ScanGrid::Place placeOf(const Beam& beam) const {
    return m_free[0].placeOf(ScanBeams::voxelOf(beam.end) - m_free[0].firstVoxel());
  }

  InsertionReport m_report;
  std::vector<ScanGrid> m_free;  ///< one per thread, united in the first
  HitTiles m_hits;
  HitTiles m_clippedEnds;      ///< of beams beyond the range, to carve each end voxel once
  std::vector<bool> m_carves;  ///< per point: whether its beam carves; empty: all do
  std::vector<std::uint32_t> m_endRanks;  ///< per point: rank of the voxel that it hit
  ScanPyramid m_pyramid;
  HitVotes m_votes;
};

}  // namespace semantic_octree
