#include <semantic_planning/planner/SemanticPlanner.h>

#include <colored_graph/CostModel.h>
#include <semantic_planning/planner/PlanResult.h>

#include "PlannerCore.h"

namespace semantic_planning {

using semantic_octree::ReadLock;

void PlannerOptions::describe(strict_files::OptionList& list) {
  roadmap.describe(list);
  list.add("shorten", shorten, "", "look for a path of less price beside the graph's best one");
  list.add("strict", strict, "",
           "never go through a worse class to save length (as if all rates in the order were inf)");
  ground.describe(list);
}

void PlannerOptions::validate() const {
  vehicle.validate();
  strict_files::checkOptions(*this, "PlannerOptions");
}

SemanticPlanner::SemanticPlanner(semantic_octree::SemanticOcTree& map,
                                 const colored_graph::ClassOrder& order,
                                 const PlannerOptions& options)
    : m_map(&map) {
  const ReadLock lock(map);
  m_core = std::make_unique<PlannerCore>(map, order, options);
}

SemanticPlanner::~SemanticPlanner() = default;
SemanticPlanner::SemanticPlanner(SemanticPlanner&&) noexcept = default;

PlanResult SemanticPlanner::plan(const mrpt::math::TPose2D& start, const mrpt::math::TPose2D& goal,
                                 std::optional<double> startZ, std::optional<double> goalZ) {
  const ReadLock lock(*m_map);
  return m_core->plan({start, startZ}, {goal, goalZ});
}

UpdateResult SemanticPlanner::update() {
  const ReadLock lock(*m_map);
  return m_core->update();
}

PlanResult SemanticPlanner::replan(const mrpt::math::TPose2D& start, std::optional<double> startZ) {
  const ReadLock lock(*m_map);
  return m_core->replan({start, startZ});
}

void SemanticPlanner::begin(const mrpt::math::TPose2D& start,
                            const std::optional<mrpt::math::TPose2D>& goal,
                            std::optional<double> startZ, std::optional<double> goalZ) {
  const ReadLock lock(*m_map);
  m_core->begin({start, startZ},
                goal ? std::optional(PlannerCore::Place{*goal, goalZ}) : std::nullopt);
}

std::optional<PlanResult> SemanticPlanner::goOn(std::size_t& work) {
  const ReadLock lock(*m_map);
  return m_core->goOn(work);
}

void SemanticPlanner::forget() { m_core->forget(); }

const PlannerOptions& SemanticPlanner::options() const { return m_core->options(); }
const colored_graph::ClassOrder& SemanticPlanner::order() const { return m_core->order(); }
const Ground& SemanticPlanner::ground() const { return m_core->ground(); }
bool SemanticPlanner::hasPlanned() const { return m_core->hasPlanned(); }
bool SemanticPlanner::hasRoadmap() const { return m_core->hasRoadmap(); }
const Roadmap& SemanticPlanner::roadmap() const { return m_core->roadmap(); }

PlanStatus SemanticPlanner::check(const mrpt::math::TPose2D& pose, std::optional<double> z) const {
  return m_core->check({pose, z});
}

const strict_files::Choices<PlanStatus>& choicesOf(PlanStatus) {
  static const strict_files::Choices<PlanStatus> choices = {
      {"found", PlanStatus::Found},
      {"start off ground", PlanStatus::StartOffGround},
      {"start blocked", PlanStatus::StartBlocked},
      {"start forbidden", PlanStatus::StartForbidden},
      {"goal off ground", PlanStatus::GoalOffGround},
      {"goal blocked", PlanStatus::GoalBlocked},
      {"goal forbidden", PlanStatus::GoalForbidden},
      {"not connected", PlanStatus::NotConnected},
      {"only forbidden", PlanStatus::OnlyForbidden},
      {"cancelled", PlanStatus::Cancelled}};
  return choices;
}

const char* nameOf(PlanStatus status) { return strict_files::nameIn(choicesOf(status), status); }

}  // namespace semantic_planning
