#pragma once
#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <vector>

namespace semantic_driving {

/** What a vehicle can do, and how it is driven. */
struct DriveOptions {
  double maxSpeed = 1.0;             ///< m/s
  double maxAcceleration = 0.8;      ///< m/s^2, along the way; brakes, too
  double maxSideAcceleration = 0.8;  ///< m/s^2, in curves
  /** Least radius that the vehicle can drive, meters. Less than the planner's
   * (VehicleOptions::turningRadius), or there is nothing left to correct with. */
  double turningRadius = 0.8;
  /** Kept free around the footprint where the way ahead is looked at, meters: half a voxel, as
   * obstacles are the centers of columns. */
  double margin = 0.1;
  /** How far ahead the way is looked at, meters. */
  double lookAhead = 4;
  /** Whether MRPT's reactive navigator drives all forward stretches, or only around obstacles that
   * stand in the planned way. */
  bool alwaysReactive = true;
  /** Stretches and ends of stretches shorter than this follow the path exactly, meters. */
  double exactEnd = 2;
  /** Observations older than this (seconds) make the vehicle slow down; it stops when they are
   * three times as old. */
  double maxSensorAge = 0.8;

  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
  /** Highest speed with observations of an age, m/s. */
  double speedFor(double sensorAge) const;
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
/** The same with heights above the ground, as senseObstacles3() gives them. */
using ObstaclePoints3 = std::vector<Eigen::Vector3d>;

}  // namespace semantic_driving
