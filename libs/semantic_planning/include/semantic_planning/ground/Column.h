#pragma once
#include <semantic_octree/Column.h>

namespace semantic_planning {

using semantic_octree::Column;
using semantic_octree::firstColumnOf;
using semantic_octree::indexInTile;
using semantic_octree::kTileColumns;
using semantic_octree::kTileEdge;
using semantic_octree::lastColumnOf;
using semantic_octree::tileOf;

}  // namespace semantic_planning
