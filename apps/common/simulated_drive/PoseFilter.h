#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_octree/SemanticOcTree.h>
#include <synthetic_world/Random.h>

#include <Eigen/Core>
#include <vector>

#include "PoseOptions.h"
#include "SimulatedSensors.h"

namespace simulated_drive {

/** Where the robot believes to be: odometry with noise, corrected by the map's likelihood of what
 * it sees. A Gaussian particle filter (Kotecha and Djuric 2003): the belief is a normal
 * distribution of x, y and heading; particles drawn from it are weighted, and give its mean and
 * covariance anew. */
class PoseFilter {
 public:
  /** \param seed of the noise; that of odometry is the same with correction and without */
  PoseFilter(const mrpt::math::TPose2D& start, const PoseOptions& options, std::uint64_t seed);

  /** \param motion true motion since the last call, in the robot's frame before it */
  void move(const mrpt::math::TPose2D& motion);
  /** \param map without what was seen now
   * \param T_level_robot height, roll and pitch: from the robot on the ground to the frame with the
   * robot's x, y and heading, and the map's z */
  void correct(const semantic_octree::SemanticOcTree& map, const std::vector<Observation>& seen,
               const Eigen::Isometry3d& T_level_robot);

  const mrpt::math::TPose2D& pose() const { return m_pose; }
  /** What odometry alone says. */
  const mrpt::math::TPose2D& odometry() const { return m_odometry; }

 private:
  struct Point {
    Eigen::Vector3d place;  ///< level frame
    semantic_types::ClassId id;
  };
  using Points = std::vector<Point>;
  using Particles = std::vector<Eigen::Vector3d>;  ///< differences from m_pose: m, m, rad

  Points select(const semantic_octree::SemanticOcTree& map, const std::vector<Observation>& seen,
                const Eigen::Isometry3d& T_level_robot) const;
  Particles drawParticles();
  mrpt::math::TPose2D shifted(const Eigen::Vector3d& difference) const;
  /** \param weights logarithms of them */
  void fit(const Particles& particles, std::vector<double> weights);

  PoseOptions m_options;
  mrpt::math::TPose2D m_pose, m_odometry;
  Eigen::Matrix3d m_covariance = Eigen::Matrix3d::Zero();
  synthetic_world::Random m_noise, m_draws;
};

}  // namespace simulated_drive
