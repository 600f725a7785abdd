#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_planning/planner/PlanResult.h>

#include <deque>
#include <vector>

namespace semantic_driving {

/** Where a vehicle has been, so that it can go back. What it goes back on is no track any more. */
class DrivenTrack {
 public:
  /** \param length so much is kept at least, meters */
  explicit DrivenTrack(double length = 10) : m_length(length) {}

  /** Called often, with each place where the vehicle is; map frame. */
  void add(const mrpt::math::TPose2D& pose);
  /** From the last place back to the first one that is kept, headings as they were; z is 0. */
  std::vector<semantic_planning::PathPoint> back() const;

 private:
  double m_length;
  std::deque<mrpt::math::TPose2D> m_poses;
};

}  // namespace semantic_driving
