#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>

#include <string>
#include <vector>

#include "Instances.h"
#include "Trial.h"

namespace planning_study {

/** OMPL's planners that know costs: "prm*", "lazy-prm*", "bit*". */
const std::vector<std::string>& peerNames();

/** One of them, on the same ground, with the same vehicle, curves and checks. OMPL has costs of one
 * number: an edge costs the integral of 10^rank along it. \param seconds of processor time */
Trial runPeer(const std::string& name, const semantic_planning::SemanticPlanner& planner,
              const Instance& instance, double seconds);

}  // namespace planning_study
