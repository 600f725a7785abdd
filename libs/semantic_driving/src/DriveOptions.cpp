#include <semantic_driving/DriveOptions.h>

#include <semantic_types/ClassTable.h>

#include <algorithm>
#include <cmath>

namespace semantic_driving {

using strict_files::above;
using strict_files::atLeast;
using strict_files::OptionList;

void DriveOptions::describe(OptionList& list) {
  list.add("max_speed", maxSpeed, "m/s", above(0), "highest speed");
  list.add("max_acceleration", maxAcceleration, "m/s^2", above(0),
           "along the way and in curves; stops are planned with 0.8 of it");
  list.add("slow_rank", slowRank, "", atLeast(0),
           "on classes of this rank (0: the best) and worse ones slow_rank_speed holds");
  list.add("slow_rank_speed", slowRankSpeed, "m/s", above(0).orInfinite(),
           "highest speed there; inf: no limit");
  list.add("max_sensor_age", maxSensorAge, "s", above(0),
           "older observations make the vehicle slow down, and stop when three times as old");
  list.add("reaction_time", reactionTime, "s", atLeast(0), "time until a command has an effect");
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

namespace {

constexpr double kStill = 1e-3;  // m/s

double towards(double from, double to, double most) {
  return from + std::clamp(to - from, -most, most);
}

/** Where a command wants the steering; a stop leaves it where it is. */
double bendOf(const DriveCommand& wanted, const Motion& motion) {
  return std::abs(wanted.speed) > kStill ? wanted.turn / wanted.speed : motion.curvature;
}

/** The speed at which the steering is where it should be after a short way, and passengers bear the
 * curve. \param off what the steering lacks, 1/m */
double speedFor(double curvature, double off, const DriveOptions& limits) {
  constexpr double kWay = 0.2;  // m
  double most = std::sqrt(limits.maxAcceleration / std::max(1e-9, std::abs(curvature)));
  if (off > 0) most = std::min(most, kWay * limits.steeringRate() / off);
  return std::max(most, DriveOptions::kSlowest);
}

/** The greatest acceleration that a limited jerk takes back before the speed has changed so much.
 * The steps are a, a - J, ..., a - nJ, the last of them less than J. */
double accelerationFor(double change, double seconds, const DriveOptions& limits) {
  const double sum = std::abs(change) / seconds;  // of the accelerations
  const double less = limits.maxJerk * seconds;   // J
  const double n = std::floor(std::sqrt(2 * sum / less + 0.25) - 0.5);
  const double most = n > 0 ? (sum + less * n * (n + 1) / 2) / (n + 1) : sum;
  return std::copysign(std::min(limits.maxAcceleration, most), change);
}

}  // namespace

Motion next(const Motion& last, const DriveCommand& wanted, double speed, double seconds,
            const DriveOptions& limits) {
  Motion motion = last;
  motion.speed = speed;
  if (!(seconds > 0)) return motion;
  const double bend = bendOf(wanted, last);
  motion.curvature = towards(last.curvature, bend, limits.steeringRate() * seconds);
  const double most = speedFor(motion.curvature, std::abs(bend - motion.curvature), limits);
  const double change = std::clamp(wanted.speed, -most, most) - speed;
  motion.acceleration = towards(last.acceleration, accelerationFor(change, seconds, limits),
                                limits.maxJerk * seconds);
  motion.speed = speed + motion.acceleration * seconds;
  return motion;
}

Motion steered(const Motion& motion, const DriveCommand& wanted, double seconds,
               const DriveOptions& limits) {
  Motion later = motion;
  later.curvature =
      towards(motion.curvature, bendOf(wanted, motion), limits.steeringRate() * seconds);
  return later;
}

double restingWay(double speed, const DriveOptions& limits) {
  constexpr double kShare = 0.9375;  // of braking(): so gently that the tracker keeps to it
  return speed * speed / (2 * (kShare * limits.braking())) +
         speed * delayOfStop(limits.maxAcceleration / 2, limits);
}

double delayOfStop(double acceleration, const DriveOptions& limits) {
  const double all = std::max(0.0, acceleration) + limits.maxAcceleration;
  return all * all / (2 * limits.maxJerk * limits.maxAcceleration);
}

}  // namespace semantic_driving
