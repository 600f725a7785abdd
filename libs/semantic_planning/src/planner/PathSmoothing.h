#pragma once
#include <semantic_planning/vehicle/PathPoint.h>

#include <vector>

#include "LatticeSearch.h"

namespace semantic_planning {

/** A path of lower price whose steering changes less often and turns less: stretches of constant
 * curvature between two others are replaced by one that is tangent to both, as long as motion cost
 * and classes together cost less. Gears stay as they are, and so do ways backwards. */
std::vector<Leg> smoothed(const std::vector<PathPoint>& path, const CollisionChecker& checker,
                          const ClassPrices& prices);

/** The stretches of constant curvature that a path is made of. */
std::vector<Leg> legsAlong(const std::vector<PathPoint>& path, const CollisionChecker& checker,
                           const ClassPrices& prices);

}  // namespace semantic_planning
