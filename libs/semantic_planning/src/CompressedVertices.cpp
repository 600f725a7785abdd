#include <algorithm>
#include <cmath>

#include "Candidates.h"

namespace semantic_planning {

using semantic_octree::Abstraction;
using semantic_octree::LeafCell;

namespace {

/** Mixes the bits of three numbers (the finalizer of MurmurHash3). */
std::uint32_t mixed(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  std::uint32_t h = a * 0x9e3779b1u ^ b * 0x85ebca77u ^ c * 0xc2b2ae3du;
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  return h ^ (h >> 16);
}

double unit(std::uint32_t h) { return h / 4294967296.0; }

/** A square of columns in which one point is wanted. */
struct Cell {
  Column low;
  int edge;
};

/** The largest power of two of voxels that is no larger than this. */
int powerOfTwoWithin(double voxels) {
  int edge = 1;
  while (2 * edge <= voxels) edge *= 2;
  return edge;
}

std::vector<Cell> cellsOf(Column low, int size, int largest) {
  const int edge = std::min(size, largest);
  std::vector<Cell> cells;
  for (int y = 0; y < size; y += edge)
    for (int x = 0; x < size; x += edge) cells.push_back({{low.x + x, low.y + y}, edge});
  return cells;
}

void addHeadings(Column column, int z, double priority, std::optional<ClassId> classId,
                 const CandidateSearch& search, std::vector<Candidate>& candidates) {
  const double x = search.ground.centerOf(column.x), y = search.ground.centerOf(column.y);
  if (!search.region.contains(x, y)) return;
  for (const double heading : headingsAt(column, search.options))
    candidates.push_back({{{x, y, heading}, z}, priority, classId});
}

/** Whether a leaf may hold points of the region. */
bool nearRegion(const LeafCell& leaf, int size, const CandidateSearch& search) {
  const double x = search.ground.centerOf(leaf.key[0]), y = search.ground.centerOf(leaf.key[1]);
  return search.region.contains(x, y, size * search.ground.voxelSize());
}

ClassId likeliestIn(const LeafCell& leaf, const Abstraction& abstraction) {
  const std::vector<double> p = abstraction.distribution(leaf);
  return static_cast<ClassId>(std::max_element(p.begin() + 1, p.end()) - p.begin());
}

/** Large cells go before small ones: the middle of what is all alike comes before its border, where
 * most leaves are. */
double priorityOf(const Cell& cell, unsigned seed) {
  const auto edge = static_cast<unsigned>(cell.edge);
  return 1.0 / edge *
         dither(static_cast<unsigned>(cell.low.x) / edge, static_cast<unsigned>(cell.low.y) / edge,
                seed + edge);
}

}  // namespace

double dither(unsigned x, unsigned y, unsigned seed) {
  double value = 0, weight = 0.5;
  for (unsigned bit = 0; bit < 16; ++bit, weight /= 4) {
    value += weight * (((x ^ y) >> bit) & 1);
    value += weight / 2 * ((y >> bit) & 1);
  }
  value += unit(mixed(seed, 1, 2));
  return value - std::floor(value);
}

std::vector<double> headingsAt(Column point, const RoadmapOptions& options) {
  const double first = unit(mixed(static_cast<std::uint32_t>(point.x),
                                  static_cast<std::uint32_t>(point.y), options.seed));
  std::vector<double> headings;
  for (int i = 0; i < options.headings; ++i)
    headings.push_back(std::remainder(2 * M_PI * (first + i) / options.headings, 2 * M_PI));
  return headings;
}

std::vector<Candidate> candidatesIn(const LeafCell& leaf, const Abstraction& abstraction,
                                    const CandidateSearch& search) {
  if (!leaf.node || leaf.node->getLogOdds() <= 0) return {};
  const int size = 1 << (16 - leaf.depth);
  if (!nearRegion(leaf, size, search)) return {};
  const int z = leaf.key[2] & ~(size - 1);
  const Column low{leaf.key[0] & ~(size - 1), leaf.key[1] & ~(size - 1)};
  const int largest = powerOfTwoWithin(search.options.spacing / search.ground.voxelSize());
  std::optional<ClassId> classId;
  if (search.options.classOfLeaf) classId = likeliestIn(leaf, abstraction);
  std::vector<Candidate> candidates;
  for (const Cell& cell : cellsOf(low, size, largest)) {
    const Column center{cell.low.x + cell.edge / 2, cell.low.y + cell.edge / 2};
    for (const Surface& s : search.ground.surfaces(center))
      if (s.drivable && s.z >= z && s.z < z + size)
        addHeadings(center, s.z, priorityOf(cell, search.options.seed), classId, search,
                    candidates);
  }
  return candidates;
}

std::vector<Candidate> gridCandidates(const CandidateSearch& search) {
  const int edge = powerOfTwoWithin(search.options.spacing / search.ground.voxelSize());
  std::vector<Candidate> candidates;
  for (const Column& tile : search.ground.tiles())
    for (const Cell& cell : cellsOf(firstColumnOf(tile), kTileEdge, edge))
      for (const Surface& s : search.ground.surfaces(cell.low))
        if (s.drivable)
          addHeadings(cell.low, s.z, priorityOf(cell, search.options.seed), {}, search, candidates);
  return candidates;
}

}  // namespace semantic_planning
