#include <mrpt/math/wrap2pi.h>
#include <semantic_driving/GuideTransitions.h>

#include <cmath>

namespace semantic_driving {

void GuideOptions::describe(strict_files::OptionList& list) {
  using strict_files::above;
  using strict_files::atLeast;
  list.add("period", period, "s", atLeast(0), "between looks for a better path");
  list.add("patience", patience, "s", atLeast(0),
           "for what stands in the way to go away, or to be passed");
  list.add("goal_patience", goalPatience, "s", atLeast(0),
           "for what stands in the goal's place to go away, until it is said that it does not fit");
  list.add("drive_to_nearest", driveToNearest, "",
           "drives to the nearest pose that fits then, within 5 m; or stops, and says which it is");
  list.add(
      "at_goal", atGoal, "m", above(0),
      "so near to the goal's place is there; where it does not fit, a pose that does within 0.7 "
      "of that, headed within 23 degrees, takes its place");
  list.add(
      "longest_backwards", longestBackwards, "m", atLeast(0),
      "a path with a longer stretch backwards is worse than one without, whatever its classes");
  list.add("frontier_radius", frontierRadius, "m", above(0),
           "how far places are looked for from which more of the way to the goal is seen");
}

bool GuideOptions::isAsGood(const mrpt::math::TPose2D& pose,
                            const mrpt::math::TPose2D& goal) const {
  constexpr double kShare = 0.7, kHeading = 0.4;  // of what counts as there; rad
  return std::hypot(pose.x - goal.x, pose.y - goal.y) <= kShare * atGoal &&
         std::abs(mrpt::math::wrapToPi(pose.phi - goal.phi)) <= kHeading;
}

void GuideOptions::validate() const { strict_files::checkOptions(*this, "GuideOptions"); }

}  // namespace semantic_driving
