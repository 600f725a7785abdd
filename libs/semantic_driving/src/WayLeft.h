#pragma once
#include <queue>
#include <utility>
#include <vector>

#include "GoalRegion.h"
#include "GroundFlood.h"

namespace semantic_driving {

/** The least way from anywhere on to a goal, if all that is not known to be in the way is not:
 * Dijkstra's search from the goal, over ground that is reached as its rank counts, else as the
 * unknown does. (The freespace assumption: Koenig and Likhachev, "D* Lite", 2002.) */
class WayLeft {
 public:
  WayLeft(const semantic_planning::SemanticPlanner& planner, const GroundFlood& flood,
          const GoalRegion& region, const mrpt::math::TPose2D& goal,
          const FrontierOptions& options);

  /** Weighted meters; infinite where something is in the way. \param c in the square */
  double from(semantic_planning::Column c) const { return m_ways[m_square.indexOf(c)]; }

 private:
  using Open = std::pair<double, std::size_t>;

  void start(const mrpt::math::TPose2D& goal, double around);
  void search();
  void offer(semantic_planning::Column c, double way);
  void goAround(double x, double y, double way);
  double costOf(semantic_planning::Column c) const;

  const semantic_planning::SemanticPlanner& m_planner;
  const semantic_planning::Ground& m_ground;
  const GroundFlood& m_flood;
  const GoalRegion& m_region;
  ColumnSquare m_square;
  double m_unknown;  ///< what a meter through it counts
  std::vector<double> m_ways;
  bool m_around = false;  ///< the rim is reached
  std::priority_queue<Open, std::vector<Open>, std::greater<>> m_open;
};

}  // namespace semantic_driving
