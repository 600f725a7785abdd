#pragma once
#include <semantic_octree/Abstraction.h>

#include "StreamTree.h"

namespace semantic_octree {

/** A part, and when it is its turn. */
struct OrderedPart {
  TreePart part;
  /** The tree of Abstraction::alphaPath() that it is part of first; leaves at the trees' roots and
   * above are of tree 0. */
  std::size_t step = 0;
  /** The tree without it, and what comes behind it, is optimal for some alpha. */
  bool begins = true;
};

/** What leads from a stream's tree to the compressed tree of a map. */
struct TreeParts {
  /** By step, then depth first. */
  std::vector<OrderedPart> parts;
  /** Of each step: an alpha that leads to its tree, and the alpha at which what it brings is worth
   * its price. The last is the map's own. */
  std::vector<double> alphas, ties;
};
TreeParts partsOfChange(SemanticOcTree& map, const StreamTree& before);

}  // namespace semantic_octree
