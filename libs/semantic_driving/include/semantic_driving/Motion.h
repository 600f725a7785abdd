#pragma once
#include <semantic_driving/DriveOptions.h>

namespace semantic_driving {

/** How a vehicle is told to move. */
struct Motion {
  double speed = 0;         ///< m/s, negative: backwards
  double acceleration = 0;  ///< m/s^2
  double curvature = 0;     ///< of the steering, 1/m

  DriveCommand command() const { return {speed, speed * curvature}; }
};

/** The motion after `last` that comes nearest to a command and keeps to the limits of acceleration,
 * jerk and steering. Slow where the steering is not there yet.
 * \param speed now, m/s \param seconds until it is reached */
Motion next(const Motion& last, const DriveCommand& wanted, double speed, double seconds,
            const DriveOptions& limits);

/** A motion when the steering was turned towards a command for some seconds. */
Motion steered(const Motion& motion, const DriveCommand& wanted, double seconds,
               const DriveOptions& limits);

/** Meters that a vehicle takes to come to rest, also if it gets faster yet; a little more gently
 * than DriveOptions::braking(). \param speed m/s */
double restingWay(double speed, const DriveOptions& limits);

/** By how many seconds a limited jerk delays a stop: it ends so much later than one that brakes
 * with the whole acceleration at once. \param acceleration now, along the motion, m/s^2 */
double delayOfStop(double acceleration, const DriveOptions& limits);

}  // namespace semantic_driving
