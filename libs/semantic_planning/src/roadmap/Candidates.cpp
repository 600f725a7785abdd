#include "Candidates.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "ground/SurfaceTile.h"

namespace semantic_planning {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

/** The lowest tile of the smallest rectangle that holds the ground, and the highest one. */
std::pair<Column, Column> cornersOf(const Ground& ground) {
  const std::vector<Column> tiles = ground.tiles();
  Column low = tiles.front(), high = low;
  for (const Column& tile : tiles) {
    low = {std::min(low.x, tile.x), std::min(low.y, tile.y)};
    high = {std::max(high.x, tile.x), std::max(high.y, tile.y)};
  }
  return {low, high};
}

}  // namespace

PlanningRegion::PlanningRegion(const Ground& ground, const TPose2D& start, const TPose2D& goal,
                               double buffer)
    : m_isEverywhere(std::isinf(buffer)) {
  if (m_isEverywhere) {
    const auto [low, high] = cornersOf(ground);
    const Column first = firstColumnOf(low);
    const double half = ground.voxelSize() / 2, edge = kTileEdge * ground.voxelSize();
    m_corner = {ground.centerOf(first.x) - half, ground.centerOf(first.y) - half};
    m_along = {1, 0};
    m_length = (high.x - low.x + 1) * edge;
    m_width = (high.y - low.y + 1) * edge;
    return;
  }
  const double dx = goal.x - start.x, dy = goal.y - start.y, distance = std::hypot(dx, dy);
  m_along = distance > 0 ? TPoint2D(dx / distance, dy / distance) : TPoint2D(1, 0);
  m_length = distance + 2 * buffer;
  m_width = 2 * buffer;
  m_corner = {start.x - buffer * (m_along.x - m_along.y),
              start.y - buffer * (m_along.y + m_along.x)};
}

bool PlanningRegion::contains(double x, double y, double margin) const {
  const double dx = x - m_corner.x, dy = y - m_corner.y;
  const double along = m_along.x * dx + m_along.y * dy, across = m_along.x * dy - m_along.y * dx;
  return m_isEverywhere || (along >= -margin && along <= m_length + margin && across >= -margin &&
                            across <= m_width + margin);
}

TPoint2D PlanningRegion::at(double u, double v) const {
  const double along = u * m_length, across = v * m_width;
  return {m_corner.x + m_along.x * along - m_along.y * across,
          m_corner.y + m_along.y * along + m_along.x * across};
}

std::vector<Column> tilesIn(const PlanningRegion& region, const Ground& ground) {
  const double edge = kTileEdge * ground.voxelSize();
  std::vector<Column> tiles = ground.tiles();
  const auto isOutside = [&](const Column& tile) {
    const Column first = firstColumnOf(tile);
    const double x = ground.centerOf(first.x) + edge / 2, y = ground.centerOf(first.y) + edge / 2;
    return !region.contains(x, y, edge);
  };
  tiles.erase(std::remove_if(tiles.begin(), tiles.end(), isOutside), tiles.end());
  return tiles;
}

namespace {

/** Another sequence of the same evenness for every seed (Cranley, Patterson 1976). */
std::array<double, 4> rotated(std::array<double, 4> draw, unsigned seed) {
  double shift = 0.618033988749895 * seed;
  for (double& x : draw) {
    x += shift;
    x -= std::floor(x);
    shift *= 1.324717957244746;
  }
  return draw;
}

}  // namespace

std::optional<GroundPose> haltonPose(unsigned draw, const PlanningRegion& region,
                                     const Ground& ground, unsigned seed) {
  const auto [u, v, turn, unused] = rotated(haltonPoint(draw), seed);
  const TPoint2D p = region.at(u, v);
  const auto point = ground.find(p.x, p.y);
  if (!point) return std::nullopt;
  return GroundPose{{p.x, p.y, std::remainder(2 * M_PI * turn, 2 * M_PI)}, point->surface.z};
}

using semantic_octree::Abstraction;
using semantic_octree::LeafCell;

namespace {

/** Largest distance between points in a large leaf, meters. */
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

namespace {

constexpr double kHeadingReach = 5;   // m
constexpr int kRays = 16, kStep = 2;  // columns between places of a ray that are looked at

/** How far it goes on from a point over ground that is no worse than there, meters. */
double freeLength(const CandidatePoint& point, double direction, colored_graph::Rank rank,
                  const CollisionChecker& checker) {
  const Ground& ground = checker.ground();
  const int steps = static_cast<int>(kHeadingReach / (kStep * ground.voxelSize()));
  const double cosine = std::cos(direction), sine = std::sin(direction);
  int z = point.z;
  for (int i = 1; i <= steps; ++i) {
    const auto along = [&](double share) {
      return static_cast<int>(std::lround(i * kStep * share));
    };
    const Surface* s = ground.near({point.column.x + along(cosine), point.column.y + along(sine)},
                                   z, kStep * ground.step());
    if (!s || !s->drivable || s->clearance2 == 0 || checker.order().rank(s->classId) > rank)
      return (i - 1) * kStep * ground.voxelSize();
    z = s->z;
  }
  return kHeadingReach;
}

/** The axis of the free space around a point: that of the rays' second moments; or nothing if they
 * are much the same. */
std::optional<double> axisAt(const CandidatePoint& point, const CollisionChecker& checker) {
  const Surface* s = checker.ground().near(point.column, point.z, 0);
  const colored_graph::Rank rank = s ? checker.order().rank(s->classId) : 0;
  std::complex<double> moments;
  double sum = 0;
  for (int i = 0; i < kRays; ++i) {
    const double direction = 2 * M_PI * i / kRays,
                 length = freeLength(point, direction, rank, checker);
    moments += std::polar(length * length, 2 * direction);  // opposite rays count for one axis
    sum += length * length;
  }
  constexpr double kLeastShare = 0.1;
  if (std::abs(moments) <= kLeastShare * sum) return std::nullopt;
  return std::arg(moments) / 2;
}

}  // namespace

std::vector<GroundPose> candidatesAt(const CandidatePoint& point, const CollisionChecker& checker,
                                     const RoadmapOptions& options) {
  const double random = unitHash(static_cast<std::uint32_t>(point.column.x),
                                 static_cast<std::uint32_t>(point.column.y), options.seed);
  const bool aligned = options.kind != GraphKind::Leaves;
  const int headings = aligned ? 2 : 1;
  double first = 2 * M_PI * random / headings;
  if (const auto axis = aligned ? axisAt(point, checker) : std::nullopt)
    first = *axis + (random < 0.5 ? 0 : M_PI);
  const Ground& ground = checker.ground();
  const double x = ground.centerOf(point.column.x), y = ground.centerOf(point.column.y);
  std::vector<GroundPose> candidates;
  for (int i = 0; i < headings; ++i) {
    const double heading = std::remainder(first + 2 * M_PI * i / headings, 2 * M_PI);
    candidates.push_back({{x, y, heading}, point.z});
  }
  return candidates;
}

}  // namespace semantic_planning
