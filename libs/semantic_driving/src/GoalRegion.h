#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "GroundFlood.h"

namespace semantic_driving {

/** Where the last part of any way to a goal lies, and how long it is. A search from the goal gets
 * to these columns without passing where the vehicle can get over known ground, or must not be (the
 * freespace assumption: Koenig and Likhachev, "D* Lite", 2002).
 *
 * A way to the goal leaves the reached columns for the last time at the region's border. Exploring
 * helps only from there. If they do not border on the region, nothing helps: what is known to be in
 * the way stays there. In doubt a column belongs to the region, and exploring goes on:
 * - the unknown is passable, and so is all ground that is not known to be an obstacle;
 * - an obstacle keeps only those columns wherein no pose leaves the planner's clearance between it
 *   and the largest disc around the vehicle's origin;
 * - the rectangle's rim and all beyond it is passable;
 * - the search begins with what is passable around a goal that seems not to be;
 * - if the goal's column is reached, reached columns are passable. */
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
  bool contains(semantic_planning::Column c) const { return std::isfinite(way(c)); }
  /** Meters to the goal; infinite where none leads. \param c in the rectangle */
  double way(semantic_planning::Column c) const { return m_ways[m_columns.indexOf(c)]; }
  /** Something is in the way. \param c in the rectangle */
  bool isObstacle(semantic_planning::Column c) const { return is(kObstacle, c); }
  bool isGoalReached() const { return m_goalReached; }
  /** No reached column borders on the region: no way leads to the goal. */
  bool isEnclosed() const { return m_enclosed; }
  std::size_t columns() const { return m_size; }
  /** Whether the region goes on beyond the rectangle. */
  bool isOpen() const { return m_rim; }

 private:
  /** What a column is: where the vehicle gets, what is in the way, what is too near to that. */
  enum Mark : std::uint8_t { kReached = 1, kObstacle = 2, kKept = 4 };
  using Open = std::pair<double, std::size_t>;

  bool is(Mark mark, semantic_planning::Column c) const {
    return m_marks[m_columns.indexOf(c)] & mark;
  }
  void markObstacles(const semantic_planning::SemanticPlanner& planner,
                     const mrpt::math::TPose2D& from, double z);
  void start(const semantic_planning::Ground& ground, const mrpt::math::TPose2D& goal);
  void startOutside(const semantic_planning::Ground& ground, const mrpt::math::TPose2D& goal);
  void offer(semantic_planning::Column c, double way);
  void search();

  const ColumnRectangle m_columns;
  const double m_voxel;  ///< m
  std::vector<std::uint8_t> m_marks;
  std::vector<double> m_ways;
  double m_first = 0;  ///< no way is shorter, m
  /** By the voxels that a way is longer than the first (Dial, "Algorithm 360", 1969). */
  std::vector<std::vector<Open>> m_open;
  std::size_t m_size = 0;  ///< columns
  bool m_goalReached = false, m_enclosed = false, m_rim = false;
};

}  // namespace semantic_driving
