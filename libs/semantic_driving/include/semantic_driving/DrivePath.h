#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_planning/planner/PlanResult.h>

#include <deque>
#include <vector>

namespace semantic_driving {

/** A planned path as it is driven: places by arc length, and stretches of one gear. */
class DrivePath {
 public:
  DrivePath() = default;
  /** \param points as PlanResult::path: headings are the vehicle's, also where it backs up. Gears
   * and arc lengths are taken from the points' places. */
  explicit DrivePath(std::vector<semantic_planning::PathPoint> points);

  bool empty() const { return m_points.size() < 2; }
  double length() const { return empty() ? 0 : m_points.back().arcLength; }  ///< meters
  const std::vector<semantic_planning::PathPoint>& points() const { return m_points; }

  /** The place at an arc length (meters, clamped); `forward` is the gear from there on. */
  semantic_planning::PathPoint at(double s) const;
  /** Arc length of the place nearest to a pose, within [from, to]. A heading that is off
   * counts a little. */
  double nearest(const mrpt::math::TPose2D& pose, double from, double to) const;
  /** Where the stretch around s ends: the next change of gear after s, or the path's end. */
  double stretchEnd(double s) const;
  /** Where the stretch that s is in or at the end of began. */
  double stretchBegin(double s) const;
  /** The longest stretch backwards from s on, meters. */
  double longestBackwards(double s = 0) const;

  /** The part between two arc lengths, and then another path that begins at its end. */
  DrivePath part(double from, double to, const DrivePath& then = {}) const;

  /** Every `spacing` meters or closer a place of the stretch around s, its end among them and s
   * not. */
  std::vector<semantic_planning::PathPoint> waypoints(double s, double spacing) const;

 private:
  std::size_t segmentOf(double s) const;

  std::vector<semantic_planning::PathPoint> m_points;
  std::vector<double> m_ends;  ///< of the stretches
};

/** The pose of a point of a path. */
inline mrpt::math::TPose2D poseOf(const semantic_planning::PathPoint& p) {
  return {p.x, p.y, p.heading};
}

/** Where a vehicle has been, so that it can go back. What it goes back on is no track any more. */
class DrivenTrack {
 public:
  /** \param length so much is kept at least, meters */
  explicit DrivenTrack(double length = 10) : m_length(length) {}

  /** Called often, with each place where the vehicle is; map frame. */
  void add(const mrpt::math::TPose2D& pose);
  /** From the last place back to the first one that is kept, headings as they were; z and
   * curvatures are 0. */
  std::vector<semantic_planning::PathPoint> back() const;

 private:
  double m_length;
  std::deque<mrpt::math::TPose2D> m_poses;
};

}  // namespace semantic_driving
