#include "Scan.h"

#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>

#include "Parallel.h"
#include "RayMarking.h"

namespace semantic_octree {

using semantic_types::ClassId;
using semantic_types::LabeledCloud;
namespace {

void checkSizes(const LabeledCloud& cloud, int numClasses) {
  const auto fail = [&](const char* what, std::size_t size, std::size_t expected) {
    throw std::invalid_argument(std::string("labeled cloud: ") + std::to_string(size) + " " + what +
                                ", expected " + std::to_string(expected) + " or none");
  };
  const std::size_t n = cloud.size();
  if (!cloud.classes.empty() && cloud.classes.size() != n) fail("classes", cloud.classes.size(), n);
  if (!cloud.probabilities.empty() && cloud.probabilities.size() != n * numClasses)
    fail("probabilities", cloud.probabilities.size(), n * numClasses);
  for (const ClassId id : cloud.classes)
    if (id > numClasses)
      throw std::invalid_argument("labeled cloud: class " + std::to_string(id) +
                                  " is above the number of classes, " + std::to_string(numClasses));
  for (const float q : cloud.probabilities)
    if (!(q >= 0 && q <= 1))
      throw std::invalid_argument("labeled cloud: a class probability of " + std::to_string(q));
}

/** Tiles whose bits, and what is noted of them, fit into max_scan_memory. */
std::size_t maxTiles(const InsertionOptions& options) {
  const int grids = options.threads + (options.rays == InsertionOptions::Rays::EndVoxels ? 2 : 1);
  const std::size_t bytesPerTile = grids * ScanGrid::kWords * sizeof(std::uint64_t) + 6;
  return static_cast<std::size_t>(options.maxScanMemory) * 1000000 / bytesPerTile;
}

/** As many ray ends as stay near the processor. */
constexpr std::size_t kRaysInCache = 8192;

/** Where a beam stops carving; nothing if it carves nothing. \param begin, end relative to the grid
 */
std::optional<Eigen::Array3d> endOfFree(const BeamEnd& beam, const Eigen::Array3d& begin,
                                        const Eigen::Array3d& end, const InsertionOptions& options,
                                        double margin) {
  const bool toCenter = options.rays == InsertionOptions::Rays::EndVoxels;
  const Eigen::Array3d last = toCenter ? end.floor() + 0.5 : end;
  if (!beam.isReturn || margin <= 0) return last;
  const double length = (last - begin).matrix().norm();
  if (length <= margin) return std::nullopt;
  return begin + (last - begin) * (1 - margin / length);
}

}  // namespace

void Scan::set(const LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor, double resolution,
               int numClasses, const InsertionOptions& options) {
  checkSizes(cloud, numClasses);
  m_beams.compute(cloud, T_map_sensor, resolution, options);
  m_free.resize(options.threads);
  m_hits.cover(m_beams.lowest, m_beams.highest, maxTiles(options));
  markHits(options);
  markFree(options, options.carvingMargin / resolution);
  summarize();
  vote(cloud, numClasses);
}

void Scan::markHits(const InsertionOptions& options) {
  const bool onePerVoxel = options.rays == InsertionOptions::Rays::EndVoxels;
  if (onePerVoxel) m_clippedEnds.coverLike(m_hits);
  m_endBits.clear();
  m_carving.clear();
  const Eigen::Array3d gridOrigin = m_hits.origin();
  for (std::size_t i = 0; i < m_beams.ends.size(); ++i) {
    const BeamEnd& beam = m_beams.ends[i];
    const std::uint64_t bit = m_hits.bitOf((beam.end - gridOrigin).cast<int>());
    m_endBits.push_back(bit);
    bool seen = false;
    if (beam.isReturn)
      seen = m_hits.testAndSet(bit);
    else if (onePerVoxel)
      seen = m_clippedEnds.testAndSet(bit);
    if (!(onePerVoxel && seen)) m_carving.push_back(static_cast<std::uint32_t>(i));
  }
  if (!onePerVoxel) return;
  for (const std::uint64_t bit : m_endBits) m_clippedEnds.words()[bit >> 6] = 0;
}

void Scan::markFree(const InsertionOptions& options, double margin) {
  for (int i = 0; i < options.threads; ++i) m_free[i].coverLike(m_hits);
  inParallel(options.threads, [&](int i) { markFreePart(i, options, margin); });
}

void Scan::markFreePart(int part, const InsertionOptions& options, double margin) {
  ScanGrid& grid = m_free[part];
  const Eigen::Array3d gridOrigin = grid.origin(), begin = m_beams.origin - gridOrigin;
  const std::size_t last = m_carving.size() * (part + 1) / options.threads;
  std::vector<Eigen::Array3d> ends;
  ends.reserve(kRaysInCache);
  for (std::size_t i = m_carving.size() * part / options.threads; i < last; ++i) {
    const BeamEnd& beam = m_beams.ends[m_carving[i]];
    if (const auto end = endOfFree(beam, begin, beam.end - gridOrigin, options, margin))
      ends.push_back(*end);
    if (ends.size() == kRaysInCache || i + 1 == last) {
      markRays(grid, begin, ends.data(), ends.size());
      ends.clear();
    }
  }
}

void Scan::summarize() {
  m_pyramid.cover(m_hits);
  m_firstHit.resize(m_hits.size());
  std::uint32_t hits = 0;
  m_hits.forEachTile([&](std::size_t tile) {
    m_firstHit[tile] = hits;
    const CubeContent content = summarizeTile(tile);
    m_pyramid.set(tile, content);
    if (content.hit()) hits += countBits(m_hits.tile(tile), ScanGrid::kWords);
  });
  m_beams.report.hitVoxels = hits;
  m_pyramid.build();
}

CubeContent Scan::summarizeTile(std::size_t tile) {
  std::uint64_t* const free = m_free[0].tile(tile);
  for (std::size_t i = 1; i < m_free.size(); ++i)
    for (int w = 0; w < ScanGrid::kWords; ++w) {
      free[w] |= m_free[i].tile(tile)[w];
      m_free[i].tile(tile)[w] = 0;
    }
  const std::uint64_t* const hit = m_hits.tile(tile);
  std::uint64_t anyFree = 0, anyHit = 0, allFree = ~std::uint64_t(0);
  for (int w = 0; w < ScanGrid::kWords; ++w) {
    free[w] &= ~hit[w];  // a voxel that is hit is not also missed
    anyFree |= free[w];
    anyHit |= hit[w];
    allFree &= free[w];
  }
  CubeContent content;
  if (anyFree | anyHit) content.flags |= CubeContent::kAny;
  if (anyHit) content.flags |= CubeContent::kHit;
  if (~allFree) content.flags |= CubeContent::kNotAllFree;
  if (anyFree) m_beams.report.freeVoxels += countBits(free, ScanGrid::kWords);
  return content;
}

void Scan::vote(const LabeledCloud& cloud, int numClasses) {
  m_votes.start(m_beams.report.hitVoxels, cloud, numClasses);
  for (std::size_t i = 0; i < m_beams.ends.size(); ++i)
    if (m_beams.ends[i].isReturn) m_votes.add(rankOf(m_endBits[i]), m_beams.ends[i].point);
  m_votes.finish();
}

std::uint32_t Scan::rankOf(std::uint64_t bit) const {
  const std::size_t tile = bit / 512;
  return m_firstHit[tile] + countBitsBefore(m_hits.tile(tile), bit & 511);
}

void Scan::clear() {
  constexpr std::size_t bytesPerTile = ScanGrid::kWords * sizeof(std::uint64_t);
  m_hits.forEachTile([this](std::size_t tile) {
    if (!m_pyramid.tile(tile).any()) return;
    std::memset(m_free[0].tile(tile), 0, bytesPerTile);
    if (m_pyramid.tile(tile).hit()) std::memset(m_hits.tile(tile), 0, bytesPerTile);
  });
}

std::size_t Scan::bytes() const {
  std::size_t bytes = m_hits.bytes() + m_clippedEnds.bytes() + m_pyramid.bytes();
  for (const ScanGrid& grid : m_free) bytes += grid.bytes();
  return bytes + m_endBits.capacity() * sizeof(std::uint64_t) +
         (m_carving.capacity() + m_firstHit.capacity()) * sizeof(std::uint32_t);
}

}  // namespace semantic_octree
