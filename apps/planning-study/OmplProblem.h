#pragma once
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include "Instances.h"

namespace planning_study {

/** Poses of the vehicle, its motions and what they cost, as OMPL asks for them. */
class MotionOracle;

/** An instance as OMPL sees it. */
struct OmplProblem {
  /** Samples lie in the rectangle along the axes that holds the planner's region. */
  OmplProblem(const semantic_planning::SemanticPlanner& planner, const Instance& instance);

  std::shared_ptr<MotionOracle> oracle;
  ompl::base::SpaceInformationPtr space;
  ompl::base::ProblemDefinitionPtr definition;

  /** Meters in each class along the solution, in units. */
  std::vector<colored_graph::Length> lengthPerClass() const;
  std::size_t motionsChecked() const;
};

}  // namespace planning_study
