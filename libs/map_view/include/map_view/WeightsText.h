#pragma once
#include <semantic_abstraction/WeightsFile.h>

#include <string>

namespace map_view {

/** A solution as loadWeights() reads it, to the last bit of its numbers; terms without weight are
 * left out.
 * \throw std::invalid_argument nothing has a weight, or a term is none that files have. */
std::string weightsText(const semantic_octree::Solution& solution,
                        const semantic_octree::AbstractionOptions& space,
                        const semantic_types::ClassTable& classes);

}  // namespace map_view
