#pragma once
#include <semantic_planning/roadmap/CollisionChecker.h>
#include <semantic_planning/vehicle/PathPoint.h>

#include <optional>
#include <vector>

#include "ClassPrices.h"

namespace semantic_planning {

/** A way from one pose to the other, if one is found in a few thousand poses. It is looked for from
 * the start, then from the goal: a vehicle gets out of a narrow place sooner than into it. */
std::vector<PathPoint> wayBetween(const GroundPose& start, const GroundPose& goal,
                                  const CollisionChecker& checker, const ClassPrices& prices);

/** A path of lower price that begins, or ends, in another way. */
std::optional<std::vector<PathPoint>> withBetterBegin(const std::vector<PathPoint>& path,
                                                      const CollisionChecker& checker,
                                                      const ClassPrices& prices);
std::optional<std::vector<PathPoint>> withBetterEnd(const std::vector<PathPoint>& path,
                                                    const CollisionChecker& checker,
                                                    const ClassPrices& prices);

}  // namespace semantic_planning
