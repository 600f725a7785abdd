#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <optional>

#include "NodeStore.h"

namespace semantic_octree {

/** What a leaf holds. */
struct LeafContent {
  float occupancyLogOdds = 0;
  std::optional<Belief> record;

  void write(NodeArena& arena, Node& leaf) const {
    leaf.setValue(occupancyLogOdds);
    if (record) arena.setRecord(leaf, *record);
  }
};

/** Of a leaf, or of an inner node that becomes one: occupancy of its most occupied leaf, classes of
 * the mixture of its known leaves by volume. */
LeafContent contentOf(const SemanticOcTree& map, const Node& node);

struct ClassLogOdds {
  double logOdds;
  ClassId id;
};

/** Keeps the likeliest of the named classes by name; the others join the rest, whose value becomes
 * the logarithm of the mean odds of its members.
 * \param rest log-odds of each of the numClasses - named.size() classes that have no name */
Belief truncated(std::vector<ClassLogOdds> named, double rest, int numClasses);

}  // namespace semantic_octree
