#pragma once
#include <semantic_abstraction/Abstraction.h>

#include <utility>
#include <vector>

/** In blocks of 3.2 m. */
inline semantic_octree::AbstractionOptions optionsOf(
    std::vector<tree_abstraction::InformationTerm> terms, double alpha) {
  semantic_octree::AbstractionOptions options;
  options.weights.terms = std::move(terms);
  options.weights.alpha = alpha;
  options.blockSize = 3.2;
  return options;
}
