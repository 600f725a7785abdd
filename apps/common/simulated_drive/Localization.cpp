#include "Localization.h"

#include <cmath>

namespace simulated_drive {

using mrpt::math::TPose2D;

namespace {

constexpr double kDegree = M_PI / 180;

semantic_slam::SlamOptions knowing(const PoseOptions& pose, semantic_slam::SlamOptions slam) {
  slam.odometryShare = std::max(slam.odometryShare, pose.odometryNoise);
  slam.odometryAngle = std::max(slam.odometryAngle, pose.turnNoise);
  slam.registerAll = true;
  slam.level = true;
  return slam;
}

}  // namespace

Eigen::Isometry3d isometry(const TPose2D& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << pose.x, pose.y, 0;
  T.rotate(Eigen::AngleAxisd(pose.phi, Eigen::Vector3d::UnitZ()));
  return T;
}

void PoseOptions::describe(strict_files::OptionList& list) {
  using strict_files::between;
  list.add("odometry_noise", odometryNoise, "m", between(0, 1),
           "standard deviation of the way after a meter; grows with its square root");
  list.add("turn_noise", turnNoise, "degrees", between(0, 90),
           "of the heading after a meter; grows alike");
  list.add("correct", correct, "", "by SLAM; or odometry alone");
}

void PoseOptions::validate() const { strict_files::checkOptions(*this, "PoseOptions"); }

Localization::Localization(const TPose2D& start, const PoseOptions& options,
                           semantic_slam::SlamOptions slam, std::vector<bool> isMover,
                           std::uint64_t seed)
    : m_options(options),
      m_isMover(std::move(isMover)),
      m_pose(start),
      m_odometry(start),
      m_noise(synthetic_world::Random::ofStream(seed, 1, 0)),
      m_slam(knowing(options, std::move(slam))) {
  m_options.validate();
}

void Localization::move(const TPose2D& motion) {
  const double root = std::sqrt(std::hypot(motion.x, motion.y));
  TPose2D measured = motion;
  measured.x += m_options.odometryNoise * root * m_noise.normal();
  measured.phi += m_options.turnNoise * kDegree * root * m_noise.normal();
  m_pose = m_pose + measured;
  m_odometry = m_odometry + measured;
}

semantic_slam::Slam::Added Localization::correct(const std::vector<Observation>& seen,
                                                 const Eigen::Isometry3d& T_level_robot) {
  const auto added = m_slam.add(cloudOf(seen), Eigen::Isometry3d::Identity(),
                                isometry(m_odometry) * T_level_robot);
  const Eigen::Isometry3d T_map_robot = m_slam.poses()[added.keyframe] * added.T_keyframe_robot;
  const Eigen::Isometry3d T = T_map_robot * T_level_robot.inverse();
  m_pose = {T.translation().x(), T.translation().y(), std::atan2(T(1, 0), T(0, 0))};
  return added;
}

semantic_types::LabeledCloud Localization::cloudOf(const std::vector<Observation>& seen) const {
  semantic_types::LabeledCloud cloud;
  for (const Observation& o : seen)
    for (std::size_t i = 0; i < o.cloud.size(); ++i) {
      const semantic_types::ClassId id = o.cloud.classes[i];
      if (id < m_isMover.size() && m_isMover[id]) continue;
      cloud.points.push_back((o.T_robot_sensor * o.cloud.points[i].cast<double>()).cast<float>());
      cloud.classes.push_back(id);
    }
  return cloud;
}

}  // namespace simulated_drive
