#pragma once
#include <mrpt/obs/CObservation.h>
#include <synthetic_world/World.h>

#include "DriveConfig.h"

namespace simulated_drive {

/** What one sensor saw, once. */
struct Observation : semantic_slam::SensorScan {
  mrpt::obs::CObservation::Ptr original;  ///< for the rawlog; null if not asked for
};

/** The camera and the LiDAR of the simulated robot. */
class SimulatedSensors {
 public:
  /** \param keepOriginals make MRPT's observations, too */
  SimulatedSensors(const SensorConfig& config, bool keepOriginals)
      : m_config(config), m_keepOriginals(keepOriginals) {}

  std::vector<Observation> sense(const synthetic_world::World& world,
                                 const Eigen::Isometry3d& T_world_robot);

 private:
  Observation camera(const synthetic_world::World& world, const Eigen::Isometry3d& T_world_robot);
  Observation lidar(const synthetic_world::World& world, const Eigen::Isometry3d& T_world_robot);

  SensorConfig m_config;
  bool m_keepOriginals;
  std::uint64_t m_frame = 0;
};

}  // namespace simulated_drive
