#pragma once
#include <semantic_planning/roadmap/CollisionChecker.h>
#include <semantic_planning/vehicle/MotionCost.h>

#include <vector>

#include "ClassPrices.h"

namespace semantic_planning {

/** Poses, of which a path takes one or none. */
using Station = std::vector<GroundPose>;

/** A curve of a path. */
struct Leg {
  ReedsSheppCurve curve;
  int from;  ///< key of the surface where it begins
};

/** The path of least price from the first of some stations to the last, by dynamic programming: the
 * best way to each pose. None if no way is free. The first pose of each station, and all of the
 * first and the last one, are connected with all others. The rest are connected with poses that
 * head about the same way along the line between them.
 * \param span a curve goes on by so many stations at most */
std::vector<Leg> cheapestLegs(const std::vector<Station>& stations, std::size_t span,
                              const CollisionChecker& checker, const ClassPrices& prices);

}  // namespace semantic_planning
