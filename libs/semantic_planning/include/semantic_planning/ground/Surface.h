#pragma once
#include <semantic_octree/Column.h>
#include <semantic_types/ClassTable.h>

#include <cstdint>

namespace semantic_planning {

using semantic_octree::Column;
using semantic_octree::firstColumnOf;
using semantic_octree::indexInTile;
using semantic_octree::kTileColumns;
using semantic_octree::kTileEdge;
using semantic_octree::lastColumnOf;
using semantic_octree::tileOf;

using semantic_types::ClassId;

/** A place where the ground can be stood upon: the top voxel of something, or a filled hole, with
 * the vehicle's height free above. A column of the map may have several, as under a bridge. */
struct Surface {
  Surface() : filled(false), drivable(false) {}

  std::uint16_t z = 0;                         ///< key of its voxel
  ClassId classId = semantic_types::kNoClass;  ///< likeliest class; kNoClass: unknown
  bool filled : 1;                             ///< no voxel is known here
  bool drivable : 1;                           ///< not too steep
  /** Squared distance from this column to the nearest one where the vehicle must not be, between
   * their nearest sides, in voxels; at most Ground::largestClearance() squared. */
  std::uint16_t clearance2 = 0;
  std::uint16_t component = 0;  ///< which connected component of its tile

  bool operator==(const Surface& o) const {
    return z == o.z && classId == o.classId && filled == o.filled && drivable == o.drivable &&
           clearance2 == o.clearance2 && component == o.component;
  }
  bool operator!=(const Surface& o) const { return !(*this == o); }
};
static_assert(sizeof(Surface) == 8, "a map has one for nearly each of its columns");

/** The surfaces of a column, lowest first. */
struct SurfaceRange {
  const Surface* first = nullptr;
  const Surface* last = nullptr;
  const Surface* begin() const { return first; }
  const Surface* end() const { return last; }
  bool empty() const { return first == last; }
};

}  // namespace semantic_planning
