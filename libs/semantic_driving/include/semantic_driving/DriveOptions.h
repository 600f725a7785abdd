#pragma once
#include <colored_graph/ClassOrder.h>
#include <mrpt/math/TPose2D.h>
#include <strict_files/OptionList.h>

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace semantic_driving {

/** What a vehicle can do, and how it is driven. */
struct DriveOptions {
  double maxSpeed = 1.0;         ///< m/s
  double maxAcceleration = 0.8;  ///< m/s^2, along the way, also of the brakes, and in curves
  /** On ground of this rank and worse ones (0: the best), and unknown or forbidden ground, no
   * faster than this, m/s: walking pace. Infinite: no limit. */
  int slowRank = 3;
  double slowRankSpeed = std::numeric_limits<double>::infinity();
  /** Observations older than this (seconds) make the vehicle slow down; it stands when they are
   * three times as old. A vehicle that takes longer to brake begins earlier. */
  double maxSensorAge = 0.8;

  double reactionTime = 0.3;  ///< seconds until a command has an effect

  // For programs, without a name in files.
  double maxJerk = 3;  ///< m/s^3, along the way; infinite: no limit
  /** The least radius that the vehicle drives, and what is kept free around its footprint ahead, m:
   * setFor() takes both from vehicle and map. */
  double turningRadius = 0.8, margin = 0.1;

  static constexpr double kSlowest = 0.1;       ///< m/s, as long as there is way left
  static constexpr double kAtRest = 0.05;       ///< m/s; a slower vehicle stands
  static constexpr double kBrakingShare = 0.8;  ///< of maxAcceleration, that stops are planned with
  static constexpr double kMoverMargin = 0.25;  ///< meters between the vehicle and those who walk

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
  /** The vehicle drives tighter than the planner plans, to have something left to correct with.
   * Obstacles are the centers of columns, so half a voxel around them is not free.
   * \param plannedRadius VehicleOptions::turningRadius \param voxelSize both in meters */
  void setFor(double plannedRadius, double voxelSize);
  /** What stops are planned with, m/s^2. */
  double braking() const { return kBrakingShare * maxAcceleration; }
  /** How fast the steering turns: change of the path's curvature, 1/m per second. */
  double steeringRate() const;
  /** How far ahead the way is looked at, m: there is room to drive around what is there, and then
   * still to stop. */
  double lookAhead() const;
  /** Highest speed with observations of an age, m/s. */
  double speedFor(double sensorAge) const;
  /** Highest speed on each class, m/s. */
  std::vector<double> classSpeeds(const colored_graph::ClassOrder& order) const;
};

/** Where a vehicle is and how it moves. */
struct DriveState {
  mrpt::math::TPose2D pose;    ///< map frame
  double speed = 0, turn = 0;  ///< m/s (negative: backwards), rad/s
};

/** What a vehicle is told. */
struct DriveCommand {
  double speed = 0, turn = 0;  ///< m/s (negative: backwards), rad/s
};

/** Obstacles as senseObstacles() gives them: points in the vehicle's frame, meters. */
using ObstaclePoints = std::vector<Eigen::Vector2d>;

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
