#include <mrpt/math/wrap2pi.h>
#include <semantic_driving/GuideOptions.h>

#include <cmath>

namespace semantic_driving {

using strict_files::above;
using strict_files::atLeast;
using strict_files::between;
using strict_files::OptionList;

namespace {

constexpr double kBelowOne = 1 - 0x1p-20;

void describeChanges(GuideOptions& o, OptionList& list) {
  list.add("slow", o.slow, "m/s", atLeast(0),
           "a faster vehicle comes to rest before it leaves its path for another one");
  list.add("rest_braking", o.restBraking, "", {0, kBelowOne, false},
           "of what the tracker brakes with, to come to rest so");
  list.add("rest_margin", o.restMargin, "m", atLeast(0), "more way than that takes");
  list.add("lead_time", o.leadTime, "s", atLeast(0), "until a better path leaves the present one");
  list.add("lead_distance", o.leadDistance, "m", above(0), "least way until then");
  list.add("same_length", o.same.length, "m", atLeast(0),
           "paths that differ by less are equally good");
  list.add("same_share", o.same.share, "", between(0, 1),
           "paths that differ by less of their length are, too");
  list.add(
      "longest_backwards", o.same.backwards, "m", atLeast(0),
      "a path with a longer stretch backwards is worse than one without, whatever its classes; "
      "for a turn ahead in its place all classes will do that the path has anyway");
  list.add("shortest_shunt", o.shortestShunt, "m", atLeast(0),
           "a shorter last stretch to the goal is not worth a change of gear, and left out");
}

}  // namespace

void GuideOptions::describe(OptionList& list) {
  list.add("period", period, "s", atLeast(0), "between looks for a better path");
  list.add("patience", patience, "s", atLeast(0),
           "for what stands in the way to go away, or to be passed");
  list.add("stuck_after", stuckAfter, "s", atLeast(0),
           "without getting on, until another path is looked for");
  list.add("give_up_after", giveUpAfter, "s", atLeast(0), "at rest without any path");
  list.add("goal_patience", goalPatience, "s", atLeast(0),
           "for what stands in the goal's place to go away, until it is said that it does not fit");
  list.add("nearest_within", nearestWithin, "m", atLeast(0),
           "of a goal that does not fit, where the nearest pose that fits is looked for");
  list.add("drive_to_nearest", driveToNearest, "",
           "drives to that pose; or stops, and only says which it is");
  list.add(
      "at_goal", atGoal, "m", above(0),
      "so near to the goal's place is there; where it does not fit, a pose that does within 0.7 "
      "of that, headed within 23 degrees, takes its place");
  list.add("at_rest", atRest, "m/s", above(0), "a slower vehicle stands");
  describeChanges(*this, list);
  list.add("near_frontier", nearFrontier, "m", atLeast(0),
           "before a frontier, where the next one is looked for");
  list.add("shortest_way", shortestWay, "m", atLeast(0),
           "nearer frontiers are seen from where the vehicle is");
  list.add("back_beyond", backBeyond, "m", atLeast(0),
           "back on the track beyond where planning is possible again");
  list.add("most_times_back", mostTimesBack, "", atLeast(0),
           "back on the track without a plan between, before there is no path");
}

bool GuideOptions::isAsGood(const mrpt::math::TPose2D& pose,
                            const mrpt::math::TPose2D& goal) const {
  constexpr double kShare = 0.7, kHeading = 0.4;  // of what counts as there; rad
  return std::hypot(pose.x - goal.x, pose.y - goal.y) <= kShare * atGoal &&
         std::abs(mrpt::math::wrapToPi(pose.phi - goal.phi)) <= kHeading;
}

void GuideOptions::validate() const {
  strict_files::checkOptions(*this, "GuideOptions");
  frontiers.validate();
  recovery.validate();
}

}  // namespace semantic_driving
