#pragma once
#include <semantic_types/LabeledCloud.h>
#include <synthetic_world/SensorNoise.h>
#include <synthetic_world/World.h>

namespace synthetic_world {

using semantic_types::LabeledCloud;

/** A LiDAR that turns around its z axis. Sensor frame: x ahead, y left, z up. */
struct LidarOptions {
  int rings = 32, columns = 1024;
  double lowest = -25, highest = 15;  // elevation of the first and last ring, degrees
  double minRange = 0.8;              // m
  double maxRange = 60;               // m
  /** Share of the beams on windows, cars, water and signs that return by way of what these mirror:
   * such ghosts lie behind the surface, many of them below the ground; 0..1. */
  double ghosts = 0;
  SensorNoise noise;

  /** Unit vector of a beam, sensor frame; ring 0 is the highest, column 0 looks ahead. */
  Eigen::Vector3d beam(int ring, int column) const;
  /** Its own, without the noise, which sensors may share. */
  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field. */
  void validate() const;
};

/** One turn, taken from a single pose: the returns, ring after ring.
 * \throw std::invalid_argument the options are not valid. */
LabeledCloud scanLidar(const World& world, const Eigen::Isometry3d& T_world_lidar,
                       const LidarOptions& options, FrameSeed seed = {});

}  // namespace synthetic_world
