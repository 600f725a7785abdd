#pragma once
#include <colored_graph/ClassOrder.h>
#include <semantic_octree/AbstractionOptions.h>

namespace semantic_planning {

/** A compressed tree for planning with this order (over the map's class ids, 0 = unknown ground):
 * it keeps what tells the ranks apart, each from the others and from all that is forbidden.
 * \param alpha price of detail, see AbstractionWeights::alpha */
semantic_octree::AbstractionOptions abstractionFor(const colored_graph::ClassOrder& order,
                                                   double alpha = 0.005);

}  // namespace semantic_planning
