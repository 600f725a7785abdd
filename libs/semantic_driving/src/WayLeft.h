#pragma once
#include <utility>
#include <vector>

#include "GoalRegion.h"
#include "GroundFlood.h"

namespace semantic_driving {

/** The least way from anywhere on to a goal, if all that is not known to be in the way is not: a
 * search from the goal, over ground that is reached as its rank counts, else as the unknown does,
 * with ways in buckets (Dial, "Algorithm 360", 1969) instead of a heap. (The freespace assumption:
 * Koenig and Likhachev, "D* Lite", 2002.) */
class WayLeft {
 public:
  WayLeft(const semantic_planning::Ground& ground, const GroundFlood& flood,
          const GoalRegion& region, const mrpt::math::TPose2D& goal, double unknownFactor);

  /** How far the unknown may be from where it is seen, meters. */
  static constexpr double kSight = 1.4;

  /** Weighted meters; infinite where something is in the way.
   * \param c in the rectangle, within kSight of what is reached */
  double from(semantic_planning::Column c) const { return m_ways[m_columns.indexOf(c)]; }

 private:
  using Open = std::pair<double, std::size_t>;

  void start(const mrpt::math::TPose2D& goal);
  void search();
  std::size_t reachedIn(const std::vector<Open>& bucket) const;
  void expand(const Open& open);
  void offer(semantic_planning::Column c, double way);
  void startOutside(const mrpt::math::TPose2D& goal);
  double costOf(semantic_planning::Column c) const;

  const semantic_planning::Ground& m_ground;
  const GroundFlood& m_flood;
  const GoalRegion& m_region;
  const ColumnRectangle& m_columns;
  double m_unknown;    ///< what a meter through it counts
  double m_width;      ///< of a bucket, weighted meters
  double m_first = 0;  ///< no way is shorter, weighted meters
  double m_beyond;     ///< the farthest that is reached ways are asked for, weighted meters
  std::vector<double> m_ways;
  /** By how often the width fits into what a way is longer than the first. */
  std::vector<std::vector<Open>> m_open;
};

}  // namespace semantic_driving
