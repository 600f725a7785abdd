#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_planning/vehicle/PathPoint.h>

#include <optional>
#include <vector>

#include "LatticeSearch.h"

namespace semantic_planning {

/** A stretch of constant curvature, driven forward. */
struct Arc {
  mrpt::math::TPose2D begin;  ///< meters, radians
  double curvature = 0;       ///< 1/m, positive to the left; 0: straight
  double length = 0;          ///< meters

  /** \param s meters from the beginning, of the whole line or circle that the arc is a part of. */
  mrpt::math::TPose2D at(double s) const;
};

struct TangentArc {
  Arc arc;
  double meets;  ///< where it meets the other one: meters from the other's beginning
};

/** The only arc that leaves a pose and runs into the line or circle that `into` is a part of, in
 * its direction. Nothing if there is none, or if it turns by more than half a circle and a half. */
std::optional<TangentArc> tangentArc(const mrpt::math::TPose2D& from, const Arc& into);

/** A path of lower price whose steering changes less often and turns less. A stretch of constant
 * curvature that is tangent to two others replaces what lies between, if motion and classes
 * together cost less. Gears stay as they are, and so do ways backwards. */
std::vector<Leg> smoothed(const std::vector<PathPoint>& path, const CollisionChecker& checker,
                          const ClassPrices& prices);

}  // namespace semantic_planning
