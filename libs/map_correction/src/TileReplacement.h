#pragma once
#include <semantic_octree/store/NodeEditor.h>
#include <semantic_octree/store/TileCodes.h>

namespace semantic_octree {

/** Makes some tiles of a tree what they are in another tree, as an insertion would: nodes are
 * pruned, inner nodes' bookkeeping follows, and it is told where something changed. Both trees are
 * pruned, or both are not. */
void replaceTiles(const MergeTarget& target, const TileCodes& tiles, const NodeStore& source);

}  // namespace semantic_octree
