#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_slam/Slam.h>
#include <synthetic_world/Random.h>

#include "PoseOptions.h"
#include "SimulatedSensors.h"

namespace simulated_drive {

/** On the plane z = 0. */
Eigen::Isometry3d isometry(const mrpt::math::TPose2D& pose);

/** Where the robot believes to be: odometry with noise, corrected by SLAM. Scans are registered to
 * keyframes that do not change, not to the map that is made of them: what a pose is wrong by does
 * not come back as evidence for it. */
class Localization {
 public:
  /** \param slam but for what odometry is like, and for its level, which it knows
   * \param isMover by class: points of it are not where they were
   * \param seed of the noise; that of odometry is the same with correction and without */
  Localization(const mrpt::math::TPose2D& start, const PoseOptions& options,
               semantic_slam::SlamOptions slam, std::vector<bool> isMover, std::uint64_t seed);

  /** A map with which the robot begins, see semantic_slam::Slam. */
  void setReference(const semantic_octree::SemanticOcTree& map) { m_slam.setReference(map); }

  /** \param motion true motion since the last call, in the robot's frame before it */
  void move(const mrpt::math::TPose2D& motion);
  /** Registers what was seen now, and finds loops.
   * \param T_level_robot height, roll and pitch: from the robot on the ground to the frame with the
   * robot's x, y and heading, and the map's z
   * \return where it belongs, for the map to follow */
  semantic_slam::Slam::Added correct(const std::vector<Observation>& seen,
                                     const Eigen::Isometry3d& T_level_robot);

  const mrpt::math::TPose2D& pose() const { return m_pose; }
  /** What odometry alone says. */
  const mrpt::math::TPose2D& odometry() const { return m_odometry; }
  const semantic_slam::Slam& slam() const { return m_slam; }

 private:
  semantic_types::LabeledCloud cloudOf(const std::vector<Observation>& seen) const;

  PoseOptions m_options;
  std::vector<bool> m_isMover;
  mrpt::math::TPose2D m_pose, m_odometry;
  synthetic_world::Random m_noise;
  semantic_slam::Slam m_slam;
};

}  // namespace simulated_drive
