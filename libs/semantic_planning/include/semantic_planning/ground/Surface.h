#pragma once
#include <semantic_types/ClassTable.h>

#include <cstdint>

namespace semantic_planning {

using semantic_types::ClassId;

/** A place where the ground can be stood upon: the top voxel of something, or a bridged hole, with
 * the vehicle's height free above. A column of the map may have several, as under a bridge. */
struct Surface {
  std::uint16_t z = 0;                         ///< key of its voxel
  ClassId classId = semantic_types::kNoClass;  ///< likeliest class; kNoClass: unknown
  bool bridged = false;                        ///< no voxel is known here
  bool drivable = false;                       ///< not too steep
  /** Squared distance from this column to the nearest one where the vehicle must not be, between
   * their nearest sides, in voxels; at most Ground::farthestRoom() squared. */
  std::uint16_t room2 = 0;
  std::uint16_t part = 0;  ///< which connected part of its tile

  bool operator==(const Surface& o) const {
    return z == o.z && classId == o.classId && bridged == o.bridged && drivable == o.drivable &&
           room2 == o.room2 && part == o.part;
  }
  bool operator!=(const Surface& o) const { return !(*this == o); }
};

/** The surfaces of a column, lowest first. */
struct SurfaceRange {
  const Surface* first = nullptr;
  const Surface* last = nullptr;
  const Surface* begin() const { return first; }
  const Surface* end() const { return last; }
  bool empty() const { return first == last; }
};

}  // namespace semantic_planning
