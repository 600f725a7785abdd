#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>

#include <cstdint>
#include <vector>

#include "GroundFlood.h"

namespace semantic_driving {

/** Where the last part of any way to a goal lies. A flood from the goal gets to these columns
 * without passing where the vehicle can get over known ground, or must not be.
 *
 * A way to the goal leaves the reached columns for the last time at the region's border. Exploring
 * helps only from there. If they do not border on the region, nothing helps: what is known to be in
 * the way stays there. In doubt a column belongs to the region, and exploring goes on:
 * - the unknown is passable, and so is all ground that is not known to be an obstacle;
 * - an obstacle keeps only those columns wherein no pose leaves the planner's clearance between it
 *   and the largest disc around the vehicle's origin;
 * - beyond the rectangle everything is passable;
 * - the flood begins with what is passable around a goal that seems not to be. */
class GoalRegion {
 public:
  /** \param reached for each column of the rectangle, whether the vehicle gets there
   * \param from where the vehicle is, on ground of height z (meters) */
  GoalRegion(const semantic_planning::SemanticPlanner& planner, const ColumnRectangle& columns,
             const std::vector<bool>& reached, const mrpt::math::TPose2D& from, double z,
             const mrpt::math::TPose2D& goal);

  /** A goal that seems not to be passable counts as so wide, meters. */
  static constexpr double kAroundGoal = 1;

  /** Whether seeing an unknown column may help. \param c in the rectangle */
  bool contains(semantic_planning::Column c) const { return m_goalReached || is(kRegion, c); }
  /** The vehicle can get there. \param c in the rectangle */
  bool isReached(semantic_planning::Column c) const { return is(kReached, c); }
  /** Something is in the way. \param c in the rectangle */
  bool isObstacle(semantic_planning::Column c) const { return is(kObstacle, c); }
  /** Whether a column is too near to an obstacle for the vehicle. \param c in the rectangle */
  bool isKept(semantic_planning::Column c) const { return is(kKept, c); }
  bool isGoalReached() const { return m_goalReached; }
  /** No reached column borders on the region: no way leads to the goal. */
  bool isEnclosed() const { return m_enclosed; }
  std::size_t columns() const { return m_size; }
  /** Whether the region goes on beyond the rectangle. */
  bool isOpen() const { return m_rim; }

 private:
  /** What a column is. */
  enum Mark : std::uint8_t { kReached = 1, kObstacle = 2, kKept = 4, kRegion = 8 };

  bool is(Mark mark, semantic_planning::Column c) const {
    return m_marks[m_columns.indexOf(c)] & mark;
  }
  void markObstacles(const semantic_planning::SemanticPlanner& planner,
                     const mrpt::math::TPose2D& from, double z);
  void keepAround(semantic_planning::Column obstacle, double radius);
  void start(const semantic_planning::Ground& ground, const mrpt::math::TPose2D& goal);
  void offer(semantic_planning::Column c);
  void offerRim();
  void flood();

  const ColumnRectangle m_columns;
  std::vector<std::uint8_t> m_marks;
  std::vector<semantic_planning::Column> m_open;
  std::size_t m_size = 0;  ///< columns
  bool m_goalReached = false, m_enclosed = false, m_rim = false;
};

}  // namespace semantic_driving
