#include <semantic_driving/Motion.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace semantic_driving {

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
  double most = std::sqrt(limits.maxSideAcceleration / std::max(1e-9, std::abs(curvature)));
  if (off > 0) most = std::min(most, kWay * limits.maxSteeringRate / off);
  return std::max(most, limits.slowest);
}

/** The greatest acceleration that a limited jerk takes back until the speed has changed so much. */
double accelerationFor(double change, double seconds, const DriveOptions& limits) {
  double most = std::min(limits.maxAcceleration, std::abs(change) / seconds);
  if (std::isfinite(limits.maxJerk)) {
    constexpr double kShare = 0.9;  // as it changes from step to step only
    const double jerk = kShare * limits.maxJerk, half = jerk * seconds / 2;
    most = std::min(most, std::sqrt(2 * jerk * std::abs(change) + half * half) - half);
  }
  return std::copysign(most, change);
}

}  // namespace

Motion next(const Motion& last, const DriveCommand& wanted, double speed, double seconds,
            const DriveOptions& limits) {
  Motion motion = last;
  motion.speed = speed;
  if (!(seconds > 0)) return motion;
  const double bend = bendOf(wanted, last);
  motion.curvature = towards(last.curvature, bend, limits.maxSteeringRate * seconds);
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
      towards(motion.curvature, bendOf(wanted, motion), limits.maxSteeringRate * seconds);
  return later;
}

double delayOfStop(double acceleration, const DriveOptions& limits) {
  const double all = std::max(0.0, acceleration) + limits.maxAcceleration;
  return all * all / (2 * limits.maxJerk * limits.maxAcceleration);
}

}  // namespace semantic_driving
