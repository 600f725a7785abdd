#pragma once
#include <semantic_planning/SemanticPlanner.h>

#include "Instances.h"
#include "Trial.h"

namespace planning_study {

/** How the edges of a graph count; all but the last: COA* with this model. */
extern const char* const kWeighted;  ///< one number for all classes: rank k weighs 10^k
const char* nameOf(colored_graph::EdgeModel model);

/** Plans with one kind of graph and one budget.
 *
 * The planner makes the graph; then every judgment searches a copy of it, in which nothing is
 * evaluated, so that times do not depend on what was searched before. */
class RoadmapTrials {
 public:
  /** \param map must outlive this. \param kept whether the planner remembers edges from one
   * instance to the next \throw as SemanticPlanner's constructor */
  RoadmapTrials(semantic_octree::SemanticOcTree& map, const colored_graph::ClassOrder& order,
                semantic_planning::PlannerOptions options, bool kept);

  /** \param judgments names of models, or kWeighted. \return one trial for each */
  std::vector<Trial> run(const Instance& instance, const std::vector<std::string>& judgments);

  const semantic_planning::SemanticPlanner& planner() const { return m_planner; }
  bool kept() const { return m_kept; }

 private:
  semantic_planning::SemanticPlanner m_planner;
  bool m_kept;
};

}  // namespace planning_study
