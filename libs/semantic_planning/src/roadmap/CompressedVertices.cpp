#include <algorithm>
#include <cmath>

#include "Candidates.h"
#include "UnitHash.h"

namespace semantic_planning {

using semantic_octree::Abstraction;
using semantic_octree::LeafCell;

namespace {

/** Largest distance between points in a large leaf, or of the grid, meters. */
constexpr double kSpacing = 2;

/** A square of columns in which one point is wanted. */
struct Cell {
  Column low;
  int edge;

  Column center() const { return {low.x + edge / 2, low.y + edge / 2}; }
};

/** The largest power of two of voxels that is no larger than this. */
int powerOfTwoWithin(double voxels) {
  int edge = 1;
  while (2 * edge <= voxels) edge *= 2;
  return edge;
}

/** f(cell) for the cells of a square (`size` columns from `low`) whose centers are in a tile. */
template <class F>
void forCellsOf(Column low, int size, int largest, Column tile, F f) {
  const int edge = std::min(size, largest);
  const Column first = firstColumnOf(tile);
  const auto begin = [&](int of, int at) { return std::max(of, at & ~(edge - 1)); };
  for (int y = begin(low.y, first.y); y < std::min(low.y + size, first.y + kTileEdge); y += edge)
    for (int x = begin(low.x, first.x); x < std::min(low.x + size, first.x + kTileEdge); x += edge)
      if (const Cell cell{{x, y}, edge}; tileOf(cell.center()) == tile) f(cell);
}

/** The largest cells into which leaves are split, in voxels. */
int largestCell(const Ground& ground, const RoadmapOptions& options) {
  constexpr int kTree = 65536;
  return options.kind == GraphKind::Leaves ? kTree
                                           : powerOfTwoWithin(kSpacing / ground.voxelSize());
}

/** Large cells go before small ones: the middle of what is all alike comes before its border, where
 * most leaves are. Of leaves as published, each is as likely to be taken as any other. */
double priorityOf(const Cell& cell, const RoadmapOptions& options) {
  const auto edge = static_cast<unsigned>(cell.edge);
  const auto x = static_cast<unsigned>(cell.low.x), y = static_cast<unsigned>(cell.low.y);
  if (options.kind == GraphKind::Leaves) return unitHash(x, y, options.seed + 1);
  return 1.0 / edge * dither(x / edge, y / edge, options.seed + edge);
}

}  // namespace

double dither(unsigned x, unsigned y, unsigned seed) {
  std::uint32_t bits = 0;  // of both by turns, lowest first
  for (unsigned bit = 0; bit < 16; ++bit)
    bits = bits << 2 | ((x ^ y) >> bit & 1) << 1 | (y >> bit & 1);
  const double value = bits * 0x1p-32 + unitHash(seed, 1, 2);
  return value - std::floor(value);
}

std::vector<CandidatePoint> compressedPoints(Column tile, const Abstraction& abstraction,
                                             const Ground& ground, const RoadmapOptions& options) {
  const int largest = largestCell(ground, options);
  const Column first = firstColumnOf(tile);
  const auto key = [&](int offset, int z) {
    return octomap::OcTreeKey(static_cast<std::uint16_t>(first.x + offset),
                              static_cast<std::uint16_t>(first.y + offset),
                              static_cast<std::uint16_t>(z));
  };
  std::vector<CandidatePoint> points;
  for (const LeafCell& leaf : abstraction.leavesIn(key(0, 0), key(kTileEdge - 1, 65535), true)) {
    const int size = leaf.edge(), z = leaf.lowest.z();
    const Column low{leaf.lowest.x(), leaf.lowest.y()};
    forCellsOf(low, size, largest, tile, [&](const Cell& cell) {
      for (const Surface& s : ground.surfaces(cell.center()))
        if (s.drivable && s.z >= z && s.z < z + size)
          points.push_back({cell.center(), s.z, priorityOf(cell, options)});
    });
  }
  return points;
}

std::vector<CandidatePoint> gridPoints(Column tile, const Ground& ground,
                                       const RoadmapOptions& options) {
  const int edge = powerOfTwoWithin(kSpacing / ground.voxelSize());
  std::vector<CandidatePoint> points;
  forCellsOf(firstColumnOf(tile), kTileEdge, edge, tile, [&](const Cell& cell) {
    for (const Surface& s : ground.surfaces(cell.low))
      if (s.drivable) points.push_back({cell.low, s.z, priorityOf(cell, options)});
  });
  return points;
}

}  // namespace semantic_planning
