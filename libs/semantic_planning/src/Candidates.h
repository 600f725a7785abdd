#pragma once
#include <semantic_octree/Abstraction.h>
#include <semantic_planning/EdgeChecker.h>
#include <semantic_planning/RoadmapOptions.h>

#include <cstdint>
#include <functional>
#include <vector>

#include "PlanningRegion.h"

namespace semantic_planning {

/** A pose that may become a vertex. */
struct Candidate {
  GroundPose pose;
  /** Those with smaller numbers go first, [0, 1). However many are taken, they are spread evenly.
   */
  double priority = 0;
  std::optional<ClassId> classId;  ///< of its leaf; none: that of the ground
};

/** Where to look for poses. */
struct CandidateSearch {
  const Ground& ground;
  const RoadmapOptions& options;
  const PlanningRegion& region;
};

/** Poses upon the ground that lies in a leaf of the compressed tree. */
std::vector<Candidate> candidatesIn(const semantic_octree::LeafCell& leaf,
                                    const semantic_octree::Abstraction& abstraction,
                                    const CandidateSearch& search);

/** Poses upon the finest map's ground, on a grid. */
std::vector<Candidate> gridCandidates(const CandidateSearch& search);

/** Draws from a Halton sequence over region and headings, in order, until `enough` answers true or
 * the sequence has become hopeless (a thousand draws for each vertex asked for). Draws that are not
 * over any ground are told as nothing. */
void drawHalton(const CandidateSearch& search, const colored_graph::ClassOrder& order,
                const std::function<bool(const std::optional<Candidate>&)>& enough);

/** A number in [0, 1) that spreads the cells of a grid: the fraction of cells below any bound is
 * the bound, in every neighborhood (ordered dithering, Bayer 1973). */
double dither(unsigned x, unsigned y, unsigned seed);

/** The headings at a point: evenly spaced from a direction that looks random. */
std::vector<double> headingsAt(Column point, const RoadmapOptions& options);

}  // namespace semantic_planning
