#include <semantic_planning/planner/SemanticPlanner.h>

#include <cmath>
#include <stdexcept>

#include "PlannerCore.h"

namespace semantic_planning {

void PlannerOptions::validate() const {
  vehicle.validate();
  ground.validate();
  roadmap.validate();
  reading.validate();
  if (!(timeLimit >= 0)) throw std::invalid_argument("PlannerOptions::timeLimit is not 0 or more");
}

SemanticPlanner::SemanticPlanner(semantic_octree::SemanticOcTree& map,
                                 const colored_graph::ClassOrder& order,
                                 const PlannerOptions& options)
    : m_core(std::make_unique<PlannerCore>(map, order, options)) {}

SemanticPlanner::~SemanticPlanner() = default;
SemanticPlanner::SemanticPlanner(SemanticPlanner&&) noexcept = default;

PlanResult SemanticPlanner::plan(const mrpt::math::TPose2D& start, const mrpt::math::TPose2D& goal,
                                 std::optional<double> startZ, std::optional<double> goalZ) {
  return m_core->plan({start, startZ}, {goal, goalZ});
}

UpdateResult SemanticPlanner::update() { return m_core->update(); }

PlanResult SemanticPlanner::replan(const mrpt::math::TPose2D& start, std::optional<double> startZ) {
  return m_core->replan({start, startZ});
}

void SemanticPlanner::forget() { m_core->forget(); }

const PlannerOptions& SemanticPlanner::options() const { return m_core->options(); }
const colored_graph::ClassOrder& SemanticPlanner::order() const { return m_core->order(); }
const Ground& SemanticPlanner::ground() const { return m_core->ground(); }
bool SemanticPlanner::hasRoadmap() const { return m_core->hasRoadmap(); }
const Roadmap& SemanticPlanner::roadmap() const { return m_core->roadmap(); }

PlanStatus SemanticPlanner::check(const mrpt::math::TPose2D& pose, std::optional<double> z) const {
  return m_core->check({pose, z});
}

}  // namespace semantic_planning
