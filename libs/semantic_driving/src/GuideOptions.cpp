#include <mrpt/math/wrap2pi.h>
#include <semantic_driving/GuideTransitions.h>

#include <cmath>

namespace semantic_driving {

void GuideOptions::describe(strict_files::OptionList& list) {
  list.add("patience", patience, "s", strict_files::atLeast(0),
           "for what stands in the way to go away, or to be passed; five times as long for what "
           "stands in the goal's place");
  list.add("drive_to_nearest", driveToNearest, "",
           "drives to the nearest pose that fits then, within 5 m; or stops, and says which it is");
  list.add("at_goal", atGoal, "m", strict_files::above(0), "so near to the goal's place is there");
}

bool GuideOptions::isAsGood(const mrpt::math::TPose2D& pose,
                            const mrpt::math::TPose2D& goal) const {
  constexpr double kShare = 0.7, kHeading = 0.4;  // of what counts as there; rad
  return std::hypot(pose.x - goal.x, pose.y - goal.y) <= kShare * atGoal &&
         std::abs(mrpt::math::wrapToPi(pose.phi - goal.phi)) <= kHeading;
}

void GuideOptions::validate() const { strict_files::checkOptions(*this, "GuideOptions"); }

}  // namespace semantic_driving
