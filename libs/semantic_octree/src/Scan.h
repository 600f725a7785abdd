#pragma once
#include "HitVotes.h"
#include "ScanBeams.h"
#include "ScanGrid.h"
#include "ScanPyramid.h"

namespace semantic_octree {

/** One scan turned into voxels: which were seen free, which were hit and with what class. Its
 * buffers are reused from scan to scan; their size is bounded by the box that the scan's beams
 * cross. */
class Scan {
 public:
  /** Replaces the content by this cloud's.
   * \throw std::out_of_range the sensor is outside the map
   * \throw std::invalid_argument sizes of the cloud's vectors do not match, or a class above K. */
  void set(const semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
           double resolution, int numClasses, const InsertionOptions& options);

  const InsertionReport& report() const { return m_beams.report; }
  const ScanPyramid& pyramid() const { return m_pyramid; }
  const HitVotes& votes() const { return m_votes; }

  const std::uint64_t* freeBits(std::size_t tile) const { return m_free[0].tile(tile); }
  const std::uint64_t* hitBits(std::size_t tile) const { return m_hits.tile(tile); }
  /** Rank (see HitVotes) of the first hit voxel of a tile; the others follow in Morton order. */
  std::uint32_t firstHit(std::size_t tile) const { return m_firstHit[tile]; }
  bool hasVoxels() const { return report().hitVoxels + report().freeVoxels > 0; }
  /** Forgets the voxels, keeps the buffers. */
  void clear();
  /** Of buffers that are not worth keeping for the next scan. */
  static constexpr std::size_t kTooManyBytes = 256000000;

  /** Bytes of the buffers. */
  std::size_t bytes() const;

 private:
  void markHits(const InsertionOptions& options);
  /** \param margin voxels before a return that are not carved */
  void markFree(const InsertionOptions& options, double margin);
  void markFreePart(int part, const InsertionOptions& options, double margin);
  void summarize();
  CubeContent summarizeTile(std::size_t tile);
  void vote(const semantic_types::LabeledCloud& cloud, int numClasses);
  std::uint32_t rankOf(std::uint64_t bit) const;

  ScanBeams m_beams;
  std::vector<ScanGrid> m_free;  ///< one per thread, united in the first
  ScanGrid m_hits;
  ScanGrid m_clippedEnds;  ///< end voxels of beams beyond the range, to carve each once
  std::vector<std::uint64_t> m_endBits;  ///< per beam: its end voxel's bit
  std::vector<std::uint32_t> m_carving;  ///< beams that carve
  std::vector<std::uint32_t> m_firstHit;
  ScanPyramid m_pyramid;
  HitVotes m_votes;
};

}  // namespace semantic_octree
