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
  if (off > 0) most = std::min(most, kWay * limits.steeringRate() / off);
  return std::max(most, DriveOptions::kSlowest);
}

/** The greatest acceleration that a limited jerk takes back, step by step, until the speed has
 * changed so much: with n + 1 steps a, a - J, ..., a - nJ, the last of them less than J. */
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
