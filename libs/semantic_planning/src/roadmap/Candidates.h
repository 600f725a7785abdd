#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/roadmap/CollisionChecker.h>
#include <semantic_planning/roadmap/RoadmapOptions.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <tuple>
#include <vector>

#include "PlanningRegion.h"

namespace semantic_planning {

/** A point upon the ground where vertices may be, one for each heading. */
struct CandidatePoint {
  Column column;
  int z = 0;  ///< key of its surface
  /** Those with smaller numbers go first, [0, 1). However many are taken, they are spread evenly.
   */
  double priority = 0;

  auto key() const { return std::tuple(priority, column.x, column.y, z); }
  bool operator<(const CandidatePoint& o) const { return key() < o.key(); }
  bool operator==(const CandidatePoint& o) const { return key() == o.key(); }
};

/** The points of a tile that lie in leaves of the compressed tree, in no particular order. */
std::vector<CandidatePoint> compressedPoints(Column tile,
                                             const semantic_octree::Abstraction& abstraction,
                                             const Ground& ground, const RoadmapOptions& options);

/** Points upon the finest map's ground, on a grid. */
std::vector<CandidatePoint> gridPoints(Column tile, const Ground& ground,
                                       const RoadmapOptions& options);

/** A point's poses: two in the directions in which the free space around of its class and better
 * ones runs, or one in a direction that looks random (of leaves as published). They depend on
 * ground within kHeadingReach meters. */
std::vector<GroundPose> candidatesAt(const CandidatePoint& point, const CollisionChecker& checker,
                                     const RoadmapOptions& options);
constexpr double kHeadingReach = 5;
inline bool hasAlignedHeadings(GraphKind kind) { return kind != GraphKind::Leaves; }

/** Where a Halton sequence is laid. */
struct HaltonSearch {
  const Ground& ground;
  const RoadmapOptions& options;
  const PlanningRegion& region;
};

/** Draws from a Halton sequence over the region's rectangle, or the ground's if it has none, and
 * headings, in order, until `enough` answers true or the sequence has become hopeless (a thousand
 * draws in the region for each vertex asked for). Draws that are not over any ground are told as
 * nothing. */
void drawHalton(const HaltonSearch& search,
                const std::function<bool(const std::optional<GroundPose>&)>& enough);

/** A number in [0, 1) that spreads the cells of a grid: the fraction of cells below any bound is
 * the bound, in every neighborhood (ordered dithering, Bayer 1973). */
double dither(unsigned x, unsigned y, unsigned seed);

}  // namespace semantic_planning
