#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>

#include <memory>

#include "Instances.h"
#include "Trial.h"

namespace planning_study {

/** Plans with one kind of graph and one budget. */
class RoadmapTrials {
 public:
  /** \param map must outlive this. \param kept whether the planner remembers what it found for the
   * instances before \throw as SemanticPlanner's constructor */
  RoadmapTrials(semantic_octree::SemanticOcTree& map, const colored_graph::ClassOrder& order,
                semantic_planning::PlannerOptions options, bool kept);
  ~RoadmapTrials();
  RoadmapTrials(RoadmapTrials&&) noexcept;

  /** As a robot would: judgment "profile". */
  Trial plan(const Instance& instance);
  /** All other judgments. Each searches a copy of the same graph, in which nothing is evaluated, so
   * that times do not depend on what was searched before. */
  std::vector<Trial> judge(const Instance& instance);

  const semantic_planning::SemanticPlanner& planner() const { return m_planner; }
  bool kept() const { return m_kept; }

 private:
  class SearchWatch;

  Trial trialOf(const Instance& instance, const semantic_planning::PlanResult& plan) const;

  std::unique_ptr<SearchWatch> m_watch;
  semantic_planning::SemanticPlanner m_planner;
  bool m_kept;
};

}  // namespace planning_study
