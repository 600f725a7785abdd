#pragma once
#include <semantic_planning/vehicle/Footprint.h>
#include <strict_files/OptionList.h>

#include <filesystem>

namespace semantic_planning {

/** What drives, and where it can. The frame is the vehicle's: x ahead, y to the left, the origin on
 * the ground below the middle of the unsteered axle. */
struct VehicleOptions {
  Footprint footprint;
  /** From the ground to the top, meters. What is lower than this above the ground is in the way. */
  double height = 1.0;
  /** Least radius of the origin's path, meters. */
  double turningRadius = 1.0;
  /** Kept free around the footprint, meters. */
  double clearance = 0.1;
  /** Highest step that the wheels take, meters. A step of one voxel cannot be told from a slope and
   * is always taken. */
  double stepHeight = 0.2;
  /** Steepest ground, degrees. */
  double maxSlope = 25;
  /** Between left and right wheels, meters: whose classes count. 0: one track in the middle. */
  double wheelTrack = 0.5;
  /** What a meter backwards counts, in meters forward; infinite: it only drives forward. */
  double reverseWeight = 2.5;
  /** What a change of gear counts, in meters forward. */
  double gearChange = 2.5;
  /** What a change of the steering counts, in meters forward. */
  double steeringChange = 0.1;

  /** All but the footprint, which is a list of corners (loadVehicle). */
  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** Reads a vehicle; keys that are absent have VehicleOptions' values:
 *
 *     footprint: [[-0.3, -0.3], [0.5, -0.3], [0.5, 0.3], [-0.3, 0.3]]  # m; x ahead, y left; convex
 *     height: 1.0            # m
 *     turning_radius: 1.0    # m
 *     clearance: 0.1         # m
 *     step_height: 0.2       # m
 *     max_slope: 25          # degrees
 *     wheel_track: 0.5       # m
 *     reverse_weight: 2.5    # what a meter backwards counts; inf: it only drives forward
 *     gear_change: 2.5       # m, what a change of gear counts
 *
 * \throw std::runtime_error naming file, line and value. */
VehicleOptions loadVehicle(const std::filesystem::path& file);

}  // namespace semantic_planning
