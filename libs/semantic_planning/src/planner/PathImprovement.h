#pragma once
#include <semantic_planning/planner/PlanResult.h>
#include <semantic_planning/roadmap/EdgeChecker.h>

#include <optional>
#include <vector>

namespace semantic_planning {

struct ImprovementOptions {
  double reach = 15;          ///< longest curve, meters
  double classTolerance = 0;  ///< meters, see PlannerOptions
};

/** Which of two paths is better: less way through classes worse than the best, or, where that ties
 * within a tolerance, the lower DrivePrice. Costs are those of lengths per class
 * (EdgeModel::Profile, CostKind::ArcLength). */
class PathOrder {
 public:
  using Lengths = std::vector<colored_graph::Length>;

  /** \param tolerance meters */
  PathOrder(const EdgeChecker& checker, double tolerance);

  /** By rank, worst first, without the best. \param lengths by class */
  Lengths ranks(const Lengths& lengths) const;
  Lengths ranks(const PlanResult& plan) const;
  /** The worst rank in which lengths differ by more than the tolerance, if they are worse there. */
  std::optional<std::size_t> worseRank(const Lengths& ranks, const Lengths& than) const;
  /** A path that was found is better than none, and one whose lengths are no worse than the least
   * that are known better than another one. \param least by rank; empty: none are known */
  bool isBetter(const PlanResult& plan, const PlanResult& than, const Lengths& least = {}) const;

 private:
  const EdgeChecker& m_checker;
  const colored_graph::Length m_tolerance;
};

/** Replaces a path by the best that is found beside a guide, which does not depend on the one that
 * was there before. If that has more of a class, the path itself is improved in the same way, and
 * the better one taken. \param guide RelaxedPath::path; may be empty
 * \param least by rank, the least that are known; empty: none. They become less. */
void improvePath(PlanResult& result, PathOrder::Lengths& least, const std::vector<PathPoint>& guide,
                 const EdgeChecker& checker, const ImprovementOptions& options);

}  // namespace semantic_planning
