#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_planning/ground/Ground.h>

#include <cmath>
#include <vector>

namespace semantic_planning {

/** A rectangle along the line from start to goal, with a buffer on all sides, which may be
 * infinite; or what of it is near to a path. */
class PlanningRegion {
 public:
  PlanningRegion(const mrpt::math::TPose2D& start, const mrpt::math::TPose2D& goal, double buffer);

  /** What is no farther than a distance (meters) from a path. */
  PlanningRegion near(std::vector<mrpt::math::TPoint2D> path, double distance) const;

  /** \param margin that a point may lie outside, meters */
  bool contains(double x, double y, double margin = 0) const;
  bool hasRectangle() const { return !std::isinf(m_length); }
  /** \param u, v in [0, 1], along the line and across; of the rectangle, if there is one. */
  mrpt::math::TPoint2D at(double u, double v) const;

 private:
  mrpt::math::TPoint2D m_corner, m_along;  ///< m_along: unit vector of the line
  double m_length, m_width;
  std::vector<mrpt::math::TPoint2D> m_path;  ///< empty: all of the rectangle
  double m_distance = 0;
};

/** The ground's tiles that meet the region, and perhaps some near it. */
std::vector<Column> tilesIn(const PlanningRegion& region, const Ground& ground);

}  // namespace semantic_planning
