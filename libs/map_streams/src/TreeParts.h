#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <tree_abstraction/AlphaPath.h>

#include "PartList.h"

namespace semantic_octree {

/** What leads from the map that a receiver has to the compressed tree of another map. */
struct TreeParts {
  /** By step, then depth first. A part's step is that of the alpha path's tree that it is part of
   * first; leaves at the trees' roots and above are of step 0. It begins something if the tree
   * without it, and what comes behind it, is optimal for some alpha. */
  PartList parts;
  /** Each step has an alpha that leads to its tree, and the alpha at which what it brings is worth
   * its price. The last is the map's own. */
  std::vector<double> alphas, ties;
};
/** \param before what the receiver has; null: nothing */
TreeParts partsOfChange(SemanticOcTree& map, const SemanticOcTree* before);

}  // namespace semantic_octree
