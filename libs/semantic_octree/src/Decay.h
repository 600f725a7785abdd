#pragma once
#include <semantic_octree/store/LeafContent.h>
#include <semantic_octree/store/NodeEditor.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace semantic_octree {

/** How a map forgets. At each multiple of T / 8 on the map's clock a leaf with half-life T keeps
 * 2^(-1/8) of its log-odds of occupancy, and of its classes' differences
 * (doc/how-it-works/decay.md).
 *
 * A leaf's half-life is that of its likeliest class, or of free space where it is not occupied. An
 * occupied one without a likeliest class has none. On the grid of log-odds, occupancy is rounded
 * towards 0 and differences away from it: a leaf keeps its half-life until it is unknown. So many
 * short times leave what a long one does, to the last bit. */

/** The clock's highest time, nanoseconds: 200 years. */
constexpr std::int64_t kOldestMap = 200LL * 365 * 86400 * 1000000000;

/** Steps of a half-life (seconds) between two times of the map's clock (nanoseconds), 0 or more. */
int decaySteps(double halfLife, std::int64_t from, std::int64_t to);

/** What is left of a leaf after some steps; nothing if its occupancy is within 0.1 of that of
 * unknown space. */
std::optional<LeafContent> decayed(const LeafContent& leaf, int steps, int numClasses);

/** Lets all leaves of a tree decay. Nodes are pruned, inner nodes' bookkeeping follows, and it is
 * told where something changed, as in an insertion. \param steps K + 1 numbers, [0] of free space
 */
void decay(const MergeTarget& target, const std::vector<int>& steps);

}  // namespace semantic_octree
