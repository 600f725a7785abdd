#pragma once
#include <semantic_planning/roadmap/EdgeChecker.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "roadmap/PlanningRegion.h"

namespace semantic_planning {

/** The way of a vehicle that could turn on the spot. */
struct RelaxedPath {
  PlanningRegion region;        ///< in which it was looked for
  std::vector<PathPoint> path;  ///< headings are those of travel; empty if there is no way
  /** Of the path, by rank, best first; meters. */
  std::vector<double> lengthPerRank;
};

/** What a length of each rank counts where ways are compared by one number: worse ones more than is
 * likely of all better ones. Sums stay below 2^62, whatever the number of ranks. */
std::vector<std::int64_t> weightsOfRanks(const colored_graph::ClassOrder& order);

/** From column to column in eight directions: the least way through the worst class, then through
 * the next better one, and so on (a meter of a class outweighs what is likely of all better ones).
 * It knows no turning radius, so that hardly any path has less way through the worst class. */
RelaxedPath searchRelaxed(const EdgeChecker& checker, const PlanningRegion& region,
                          const GroundPose& start, const GroundPose& goal);

}  // namespace semantic_planning
