#include <semantic_driving/DriveOptions.h>
#include <semantic_types/ClassTable.h>

#include <algorithm>

namespace semantic_driving {

using strict_files::above;
using strict_files::atLeast;
using strict_files::OptionList;

namespace {

void describeReactive(DriveOptions& o, OptionList& list) {
  list.add("always_reactive", o.alwaysReactive, "",
           "MRPT's navigator drives all forward stretches, not only around what is in the way");
  list.add("exact_end", o.exactEnd, "m", atLeast(0),
           "stretches and ends of stretches shorter than this follow the path exactly");
  list.add("waypoint_spacing", o.waypointSpacing, "m", above(0), "between MRPT's waypoints");
  list.add("waypoint_reach", o.waypointReach, "m", above(0),
           "how near to a waypoint is near enough");
  list.add("waypoint_margin", o.waypointMargin, "m", atLeast(0),
           "waypoints with less clearance around the footprint are left out");
  list.add("reactive_pause", o.reactivePause, "s", atLeast(0),
           "until MRPT's navigator is asked again after it found no way");
  list.add(
      "reactive_stall", o.reactiveStall, "s", atLeast(0),
      "MRPT's navigator may stand so long before a free way, which is then followed without it");
}

void describeSeparation(DriveOptions& o, OptionList& list) {
  list.add("mover_margin", o.moverMargin, "m", atLeast(0), "kept from those who walk");
  list.add("mover_spread", o.moverSpread, "m", atLeast(0),
           "and at most so much more for what is not known of how they do");
  list.add("mover_linger", o.moverLinger, "s", atLeast(0),
           "so long it would not stand where they walk");
}

void describeTracker(DriveOptions& o, OptionList& list) {
  list.add("braking_share", o.brakingShare, "", {0, 1, false},
           "of the acceleration, that stops are planned with");
  list.add("standoff", o.standoff, "m", atLeast(0),
           "from where the vehicle stops to what stands in its way");
  list.add("slowest", o.slowest, "m/s", above(0), "as long as there is way left");
  list.add("path_end", o.pathEnd, "m", above(0),
           "stretches of a path end when no more than this is left");
  list.add("curvature_over", o.curvatureOver, "m", above(0),
           "of the path, that its curvature is a mean over");
  list.add("side_gain", o.sideGain, "1/m^2", above(0), "of the steering, for a place off the path");
  list.add("heading_gain", o.headingGain, "1/m", above(0),
           "of the steering, for a heading off the path's");
  list.add("steering_delay", o.steeringDelay, "s", atLeast(0),
           "until the steering has an effect: so far ahead the path's curvature is taken");
  list.add("search_ahead", o.searchAhead, "m", above(0),
           "how far ahead on the path the vehicle is looked for");
  list.add("search_back", o.searchBack, "m", atLeast(0), "and how far back");
  list.add("track_length", o.trackLength, "m", above(0),
           "of the driven track that is kept to go back on");
}

}  // namespace

void DriveOptions::describe(OptionList& list) {
  list.add("max_speed", maxSpeed, "m/s", above(0), "highest speed");
  list.add("max_acceleration", maxAcceleration, "m/s^2", above(0),
           "along the way; for braking, too");
  list.add("max_side_acceleration", maxSideAcceleration, "m/s^2", above(0), "in curves");
  list.add("max_jerk", maxJerk, "m/s^3", above(0).orInfinite(), "along the way; inf: no limit");
  list.add("max_steering_rate", maxSteeringRate, "1/(m s)", above(0).orInfinite(),
           "change of the steering's curvature");
  list.add("slow_rank", slowRank, "", atLeast(0),
           "classes of this rank (0: the best), and worse ones, are driven slowly");
  list.add("slow_rank_speed", slowRankSpeed, "m/s", above(0).orInfinite(),
           "so fast at most; inf: no limit");
  list.add("turning_radius", turningRadius, "m", above(0),
           "least radius that the vehicle can drive, less than the planner's");
  list.add("margin", margin, "m", atLeast(0),
           "kept free around the footprint where the way ahead is looked at");
  list.add("look_ahead", lookAhead, "m", above(0), "how far ahead the way is looked at");
  list.add("look_step", lookStep, "m", above(0), "between poses on the way that are looked at");
  list.add("max_sensor_age", maxSensorAge, "s", above(0),
           "older observations make the vehicle slow down, and stop when three times as old");
  list.add("reaction_time", reactionTime, "s", atLeast(0), "until a command has an effect");
  list.add("moving_speed", movingSpeed, "m/s", atLeast(0), "a slower vehicle does not get on");
  describeSeparation(*this, list);
  describeReactive(*this, list);
  describeTracker(*this, list);
}

void DriveOptions::validate() const { strict_files::checkOptions(*this, "DriveOptions"); }

double DriveOptions::speedFor(double sensorAge) const {
  const double blindAt = 3 * maxSensorAge;
  const double fading = maxSpeed * std::clamp(1.5 - sensorAge / (2 * maxSensorAge), 0.0, 1.0);
  return std::min(fading, braking() * std::max(0.0, blindAt - sensorAge));
}

std::vector<double> DriveOptions::classSpeeds(const colored_graph::ClassOrder& order) const {
  std::vector<double> speeds;
  for (int id = 0; id < order.classes(); ++id) {
    const colored_graph::Rank rank = order.rank(static_cast<colored_graph::GraphClass>(id));
    const bool isSlow = id == semantic_types::kNoClass || rank >= slowRank;
    speeds.push_back(isSlow ? std::min(slowRankSpeed, maxSpeed) : maxSpeed);
  }
  return speeds;
}

}  // namespace semantic_driving
