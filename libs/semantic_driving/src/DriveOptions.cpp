#include <semantic_driving/DriveOptions.h>
#include <semantic_driving/Motion.h>
#include <semantic_types/ClassTable.h>

#include <algorithm>

namespace semantic_driving {

using strict_files::above;
using strict_files::atLeast;
using strict_files::OptionList;

void DriveOptions::describe(OptionList& list) {
  list.add("max_speed", maxSpeed, "m/s", above(0), "highest speed");
  list.add("max_acceleration", maxAcceleration, "m/s^2", above(0),
           "along the way; stops are planned with 0.8 of it");
  list.add("max_side_acceleration", maxSideAcceleration, "m/s^2", above(0), "in curves");
  list.add("max_jerk", maxJerk, "m/s^3", above(0).orInfinite(), "along the way; inf: no limit");
  list.add("slow_rank", slowRank, "", atLeast(0),
           "on classes of this rank (0: the best) and worse ones slow_rank_speed holds");
  list.add("slow_rank_speed", slowRankSpeed, "m/s", above(0).orInfinite(),
           "highest speed there; inf: no limit");
  list.add("max_sensor_age", maxSensorAge, "s", above(0),
           "older observations make the vehicle slow down, and stop when three times as old");
  list.add("reaction_time", reactionTime, "s", atLeast(0), "until a command has an effect");
}

void DriveOptions::validate() const { strict_files::checkOptions(*this, "DriveOptions"); }

void DriveOptions::setFor(double plannedRadius, double voxelSize) {
  constexpr double kTighter = 0.75;
  turningRadius = kTighter * plannedRadius;
  margin = voxelSize / 2;
}

double DriveOptions::steeringRate() const {
  constexpr double kFromLockToLock = 1.25;  // s
  return 2 / turningRadius / kFromLockToLock;
}

double DriveOptions::lookAhead() const {
  return restingWay(maxSpeed, *this) + reactionTime * maxSpeed + 2 * turningRadius;
}

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
