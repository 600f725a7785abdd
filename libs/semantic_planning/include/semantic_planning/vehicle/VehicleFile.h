#pragma once
#include <semantic_planning/vehicle/VehicleOptions.h>

#include <filesystem>

namespace semantic_planning {

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
 *     steering_change: 0.1   # m, what a change of the steering counts
 *
 * \throw std::runtime_error naming file, line and value. */
VehicleOptions loadVehicle(const std::filesystem::path& file);

}  // namespace semantic_planning
