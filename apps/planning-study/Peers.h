#pragma once
#include <semantic_planning/SemanticPlanner.h>

#include <vector>

#include "Instances.h"
#include "Trial.h"

namespace planning_study {

/** OMPL's PRM*, LazyPRM* and BIT* on the same ground, with the same vehicle, curves and checks.
 * OMPL has costs of one number: an edge costs the integral of 10^rank along it. \param seconds of
 * processor time, for each */
std::vector<Trial> runPeers(const semantic_planning::SemanticPlanner& planner,
                            const Instance& instance, double seconds);

}  // namespace planning_study
