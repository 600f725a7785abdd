#pragma once
#include <semantic_planning/planner/PlanResult.h>
#include <semantic_planning/roadmap/CollisionChecker.h>
#include <semantic_planning/roadmap/Roadmap.h>

#include <vector>

#include "ClassPrices.h"

namespace semantic_planning {

/** Appends a curve's points to a path; the first is where the last one ended, perhaps in another
 * gear. */
void appendCurve(const std::vector<PathPoint>& curve, std::vector<PathPoint>& path);

/** Lengths, cost and poses of a search's result, or why there is none. */
void describePath(const colored_graph::PathResult& path, const Roadmap& roadmap,
                  const CollisionChecker& checker, PlanResult& result);

/** What a path costs: its motion cost, and for each length in a class its rate; meters. */
double priceOf(const PlanResult& plan, const CollisionChecker& checker, const ClassPrices& prices);

/** Fills in what follows from a path's points: lengths in classes, cost, price and where its curves
 * meet. What is between two points counts by halves for the classes at both. There it may touch
 * what is forbidden: that counts for the class before. */
void setLengths(PlanResult& plan, const CollisionChecker& checker, const ClassPrices& prices);

/** The path of least price that is found beside a way, or not found. \param isDrivable whether the
 * vehicle can drive the way itself */
PlanResult pathBeside(const std::vector<PathPoint>& way, bool isDrivable,
                      const CollisionChecker& checker, const ClassPrices& prices);

}  // namespace semantic_planning
