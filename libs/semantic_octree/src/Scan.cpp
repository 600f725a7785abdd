#include <semantic_octree/store/Scan.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "Parallel.h"

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

/** Where a beam stops carving; nothing if it carves nothing. \param begin, end relative to the grid
 */
std::optional<Eigen::Array3d> endOfFree(bool isReturn, const Eigen::Array3d& begin,
                                        const Eigen::Array3d& end, const InsertionOptions& options,
                                        double margin) {
  const bool toCenter = options.rays == InsertionOptions::Rays::EndVoxels;
  const Eigen::Array3d last = toCenter ? end.floor() + 0.5 : end;
  if (!isReturn || margin <= 0) return last;
  const double length = (last - begin).matrix().norm();
  if (length <= margin) return std::nullopt;
  return begin + (last - begin) * (1 - margin / length);
}

/** Adds a tile's bits to another. Pages without any are not written to, and so cost nothing. */
void moveBits(std::uint64_t* from, std::uint64_t* to) {
  for (int w = 0; w < ScanGrid::kWords; ++w)
    if (from[w]) to[w] |= std::exchange(from[w], 0);
}

}  // namespace

std::size_t Scan::maxTiles(const InsertionOptions& options) {
  const int hitTiles = options.rays == InsertionOptions::Rays::EndVoxels ? 2 : 1;
  const std::size_t bytesPerTile = sizeof(CubeContent) +
                                   options.threads * ScanGrid::kWords * sizeof(VoxelBits) +
                                   hitTiles * (sizeof(HitTiles::Tile) + sizeof(std::uint32_t));
  return static_cast<std::size_t>(options.maxScanMemory) * 1000000 / bytesPerTile;
}

void Scan::set(const LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor, double resolution,
               const ClassFilter& filter, const InsertionOptions& options) {
  const int numClasses = filter.numClasses();
  checkSizes(cloud, numClasses);
  m_beams.set(cloud, T_map_sensor, resolution, options);
  m_report = m_beams.report();
  m_free.resize(options.threads);
  m_free[0].cover(m_beams.lowest(), m_beams.highest(), maxTiles(options));
  markHits(options);
  markFree(options, options.carvingMargin / resolution);
  summarize([&] { m_votes.count(cloud, m_endRanks, m_report.hitVoxels, numClasses); });
  m_report.labels = m_votes.agreement().explain(filter.parameters(), numClasses);
}

void Scan::markHits(const InsertionOptions& options) {
  const bool onePerVoxel = options.rays == InsertionOptions::Rays::EndVoxels;
  m_hits.cover(m_free[0].numTilesInAll());
  m_clippedEnds.cover(onePerVoxel ? m_free[0].numTilesInAll() : 0);
  m_carves.assign(onePerVoxel ? m_beams.size() : 0, false);
  for (std::size_t i = 0; i < m_beams.size(); ++i) {
    const Beam& beam = m_beams.beam(i);
    if (beam.isReturn()) {
      const bool seen = m_hits.testAndSet(placeOf(beam));
      if (onePerVoxel) m_carves[i] = !seen;
    } else if (beam.isUsed() && onePerVoxel) {
      m_carves[i] = !m_clippedEnds.testAndSet(placeOf(beam));
    }
  }
  m_report.hitVoxels = m_hits.rank();
}

void Scan::markFree(const InsertionOptions& options, double margin) {
  for (int i = 1; i < options.threads; ++i) m_free[i].coverLike(m_free[0]);
  m_endRanks.resize(m_beams.size());
  const std::size_t parts = (m_beams.size() + kBeamsAtATime - 1) / kBeamsAtATime;
  shareOut(options.threads, parts, [&](int thread, std::size_t i) {
    markFreePart(i * kBeamsAtATime, m_free[thread], options, margin);
  });
}

void Scan::markFreePart(std::size_t first, ScanGrid& grid, const InsertionOptions& options,
                        double margin) {
  const Eigen::Array3d gridOrigin = grid.origin(), begin = m_beams.origin() - gridOrigin;
  const std::size_t last = std::min(first + kBeamsAtATime, m_beams.size());
  std::vector<Eigen::Array3d> ends;
  ends.reserve(last - first);
  for (std::size_t i = first; i < last; ++i) {
    const Beam& beam = m_beams.beam(i);
    m_endRanks[i] = beam.isReturn() ? m_hits.rankOf(placeOf(beam)) : HitVotes::kNowhere;
    if (!beam.isUsed() || (!m_carves.empty() && !m_carves[i])) continue;
    if (const auto end = endOfFree(beam.isReturn(), begin, beam.end - gridOrigin, options, margin))
      ends.push_back(*end);
  }
  markRays(grid, begin, ends.data(), ends.size());
}

void Scan::summarize(const std::function<void()>& beside) {
  m_pyramid.cover(m_free[0]);
  std::atomic<std::size_t> freeVoxels{0};
  const VoxelIndex numTiles = m_free[0].numTiles();
  const auto rows = static_cast<std::size_t>(numTiles.y()) * numTiles.z();
  shareOut(static_cast<int>(m_free.size()), rows + 1, [&](int, std::size_t i) {
    i == 0 ? beside() : void(freeVoxels += summarizeRow(i - 1));
  });
  m_report.freeVoxels += freeVoxels;
  m_pyramid.build();
}

std::size_t Scan::summarizeRow(std::size_t row) {
  const VoxelIndex numTiles = m_free[0].numTiles();
  std::size_t freeVoxels = 0, number = row * numTiles.x();
  VoxelIndex tile(0, static_cast<int>(row) % numTiles.y(), static_cast<int>(row) / numTiles.y());
  for (; tile.x() < numTiles.x(); ++tile.x(), ++number)
    m_pyramid.set(number, summarizeTile(tile, number, freeVoxels));
  return freeVoxels;
}

CubeContent Scan::summarizeTile(const VoxelIndex& tile, std::size_t number,
                                std::size_t& freeVoxels) {
  std::uint64_t* const free = m_free[0].words(tile);
  for (std::size_t i = 1; i < m_free.size(); ++i) moveBits(m_free[i].words(tile), free);
  CubeContent content;
  if (m_hits.has(number)) {
    content.flags |= CubeContent::kAny | CubeContent::kHit;
    for (int w = 0; w < ScanGrid::kWords; ++w)
      free[w] &= ~m_hits.tile(number).words[w];  // a voxel that is hit is not also missed
  }
  std::uint64_t anyFree = 0, allFree = ~std::uint64_t(0);
  for (int w = 0; w < ScanGrid::kWords; ++w) {
    anyFree |= free[w];
    allFree &= free[w];
  }
  if (anyFree) content.flags |= CubeContent::kAny;
  if (~allFree) content.flags |= CubeContent::kNotAllFree;
  if (anyFree) freeVoxels += countBits(free, ScanGrid::kWords);
  return content;
}

void Scan::begin(const TileBox& box, const LabelReliability& labels, int numClasses,
                 const InsertionOptions& options) {
  reset();
  m_report.labels = labels;
  m_free.resize(1);
  // The box that ends one voxel inside of the outer tiles is the one that has no others.
  m_free[0].cover(box.lowest() * 8 - kKeyOfOrigin + 1, box.highest() * 8 - kKeyOfOrigin + 6,
                  maxTiles(options));
  m_hits.cover(m_free[0].numTilesInAll());
  m_votes.begin(numClasses);
}

void Scan::addTile(const VoxelIndex& tile, const VoxelBits* free, const VoxelBits* hit) {
  const VoxelIndex relative = tile - m_free[0].firstTile();
  std::copy_n(free, ScanGrid::kWords, m_free[0].words(relative));
  if (std::any_of(hit, hit + ScanGrid::kWords, [](VoxelBits bits) { return bits != 0; }))
    m_hits.add(m_free[0].numberOf(relative), hit);
}

void Scan::finish() {
  m_report.hitVoxels = m_hits.rank();
  summarize([] {});
}

std::vector<VoxelIndex> Scan::tiles() const {
  std::vector<VoxelIndex> tiles;
  if (!hasVoxels()) return tiles;
  m_free[0].forEachTile([&](const VoxelIndex& tile, std::size_t number) {
    if (m_pyramid.tile(number).any()) tiles.push_back(m_free[0].firstTile() + tile);
  });
  return tiles;
}

Scan::Tile Scan::tile(const VoxelIndex& tile) const {
  const VoxelIndex relative = tile - m_free[0].firstTile();
  return {m_free[0].words(relative), m_hits.tile(m_free[0].numberOf(relative))};
}

void Scan::clear() {
  m_free[0].forEachTile([this](const VoxelIndex& tile, std::size_t number) {
    if (m_pyramid.tile(number).any())
      std::fill_n(m_free[0].words(tile), ScanGrid::kWords, std::uint64_t(0));
  });
}

bool Scan::isLarge() const {
  constexpr std::size_t kTooManyBytes = 256000000;
  std::size_t bytes = 0;  // the grids': beside them the other buffers are small
  for (const ScanGrid& grid : m_free) bytes += grid.bytes();
  return bytes > kTooManyBytes;
}

void HitTiles::cover(std::size_t numTiles) {
  m_indices.assign(numTiles, 0);
  m_tiles.assign(1, Tile());
}

std::uint32_t HitTiles::rank() {
  std::uint32_t next = 0;
  for (Tile& tile : m_tiles)
    for (int w = 0; w < ScanGrid::kWords; ++w) {
      tile.ranks[w] = next;
      next += static_cast<std::uint32_t>(countOf(tile.words[w]));
    }
  return next;
}

void ScanPyramid::cover(const ScanGrid& grid) {
  const VoxelIndex last = grid.firstTile() + grid.numTiles() - 1;
  for (int level = 0; level <= kTopLevel; ++level) {
    Level& l = m_levels[level];
    for (int axis = 0; axis < 3; ++axis) {
      l.first[axis] = grid.firstTile()[axis] >> level;
      l.size[axis] = (last[axis] >> level) - l.first[axis] + 1;
    }
    l.cubes.assign(l.indexOf(l.size - 1) + 1, CubeContent());
  }
}

void ScanPyramid::build() {
  for (int level = 1; level <= kTopLevel; ++level) buildLevel(level);
}

void ScanPyramid::buildLevel(int level) {
  Level& l = m_levels[level];
  VoxelIndex i;
  for (i.z() = 0; i.z() < l.size.z(); ++i.z())
    for (i.y() = 0; i.y() < l.size.y(); ++i.y())
      for (i.x() = 0; i.x() < l.size.x(); ++i.x()) {
        CubeContent& content = l.cubes[l.indexOf(i)];
        for (int child = 0; child < 8; ++child) {
          const CubeContent part =
              at(level - 1, (l.first + i) * 2 + VoxelIndex(child & 1, child >> 1 & 1, child >> 2));
          content.add(part);
        }
      }
}

}  // namespace semantic_octree
