#pragma once
#include <semantic_planning/vehicle/PathPoint.h>

#include <functional>
#include <vector>

#include "StationSearch.h"

namespace semantic_planning {

/** Lengths by class id. */
using ClassLengths = std::vector<colored_graph::Length>;

/** A path whose steering changes less often and turns less: of its stretches of constant curvature
 * those between two others are replaced by one that is tangent to both, as long as that lowers the
 * DrivePrice. Gears stay as they are, and so do ways backwards. \param accepts whether a path may
 * have these lengths in classes */
std::vector<Leg> smoothed(const std::vector<PathPoint>& path, const EdgeChecker& checker,
                          const std::function<bool(const ClassLengths&)>& accepts);

/** The stretches of constant curvature that a path is made of. */
std::vector<Leg> legsAlong(const std::vector<PathPoint>& path, const EdgeChecker& checker);

}  // namespace semantic_planning
