#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_planning/ground/Ground.h>
#include <semantic_planning/roadmap/CollisionChecker.h>
#include <semantic_planning/roadmap/RoadmapOptions.h>

#include <array>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

namespace semantic_planning {

/** The digits of i in a base, mirrored at the point: a number in [0, 1). */
inline double radicalInverse(unsigned i, unsigned base) {
  double inverse = 0, weight = 1;
  for (; i > 0; i /= base) {
    weight /= base;
    inverse += weight * (i % base);
  }
  return inverse;
}

/** The i-th point, from 1 on, of a sequence that fills [0, 1)^4 evenly (Halton, "On the efficiency
 * of certain quasi-random sequences", 1960). */
inline std::array<double, 4> haltonPoint(unsigned i) {
  return {radicalInverse(i, 2), radicalInverse(i, 3), radicalInverse(i, 5), radicalInverse(i, 7)};
}

/** A number in [0, 1) that looks random: mixes the bits of three (the finalizer of MurmurHash3). */
inline double unitHash(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  std::uint32_t h = a * 0x9e3779b1u ^ b * 0x85ebca77u ^ c * 0xc2b2ae3du;
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  return (h ^ (h >> 16)) / 4294967296.0;
}

/** A rectangle along the line from start to goal, with a buffer on all sides. */
class PlanningRegion {
 public:
  /** \param buffer infinite: the region is everywhere, its rectangle that of the ground */
  PlanningRegion(const Ground& ground, const mrpt::math::TPose2D& start,
                 const mrpt::math::TPose2D& goal, double buffer);

  /** \param margin that a point may lie outside, meters */
  bool contains(double x, double y, double margin = 0) const;
  /** \param u, v in [0, 1], along the line and across */
  mrpt::math::TPoint2D at(double u, double v) const;

 private:
  bool m_isEverywhere;
  mrpt::math::TPoint2D m_corner, m_along;  ///< m_along: unit vector of the line
  double m_length, m_width;
};

/** The ground's tiles that meet the region, and perhaps some near it. */
std::vector<Column> tilesIn(const PlanningRegion& region, const Ground& ground);

/** A point upon the ground where vertices may be, one for each heading. */
struct CandidatePoint {
  Column column;
  int z = 0;  ///< key of its surface
  /** [0, 1). Points with smaller numbers go first: however many are taken, they spread evenly. */
  double priority = 0;

  auto key() const { return std::tuple(priority, column.x, column.y, z); }
  bool operator<(const CandidatePoint& o) const { return key() < o.key(); }
};

/** The points of a tile that lie in leaves of the compressed tree, in no particular order. */
std::vector<CandidatePoint> compressedPoints(Column tile,
                                             const semantic_octree::Abstraction& abstraction,
                                             const Ground& ground, const RoadmapOptions& options);

/** A point's poses: two along the free space around of its class and better ones, or one in a
 * direction that looks random (of leaves as published). */
std::vector<GroundPose> candidatesAt(const CandidatePoint& point, const CollisionChecker& checker,
                                     const RoadmapOptions& options);

/** A draw, from 1 on, of a Halton sequence over a region and headings; nothing if it is not over
 * any ground. */
std::optional<GroundPose> haltonPose(unsigned draw, const PlanningRegion& region,
                                     const Ground& ground, unsigned seed);

/** A number in [0, 1) for each cell of a grid. In every neighborhood the share of cells below any
 * bound is that bound (ordered dithering, Bayer 1973). */
double dither(unsigned x, unsigned y, unsigned seed);

}  // namespace semantic_planning
