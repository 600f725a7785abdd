#pragma once
#include <semantic_types/ClassTable.h>
#include <tree_abstraction/AbstractionWeights.h>

#include "Classes.h"

/** The classes of these tests, and the edge of their voxels. */
enum : semantic_types::ClassId { kRoad = 1, kGrass, kWall };
constexpr double kVoxel = 0.2;  // m

inline semantic_types::ClassTable threeClasses() { return tableOf({"road", "grass", "wall"}); }

inline tree_abstraction::AbstractionWeights relevantOnly(semantic_types::ClassId id) {
  tree_abstraction::AbstractionWeights weights;
  weights.terms = {tree_abstraction::relevant("relevant", 1, {id})};
  return weights;
}
