#include "DriveLog.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "Observations.h"

namespace synthetic_rawlog {
namespace {

/** The movement as imperfect odometry has it: each component off by its share of the way. */
Eigen::Isometry3d disturbed(const Eigen::Isometry3d& movement, double share,
                            synthetic_world::Random& random) {
  constexpr double kTurnPerMeter = 0.2;  // rad of yaw that one meter counts for
  const double way = movement.translation().norm();
  const double turn = std::abs(std::atan2(movement(1, 0), movement(0, 0))) + kTurnPerMeter * way;
  Eigen::Isometry3d result = movement;
  result.translation().x() += share * way * random.normal();
  result.translation().y() += 0.2 * share * way * random.normal();
  result.rotate(Eigen::AngleAxisd(share * turn * random.normal(), Eigen::Vector3d::UnitZ()));
  return result;
}

}  // namespace

void DriveLog::write(mrpt::Clock::time_point time, const Eigen::Isometry3d& T_map_robot,
                     const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
  for (const auto& o : observations) o->timestamp = time;
  if (m_odometry) {
    writeMovement(time, T_map_robot);
    mrpt::obs::CSensoryFrame frame;
    for (const auto& o : observations) frame.insert(o);
    m_rawlog.write(frame);
    return;
  }
  const auto pose = robotPose(T_map_robot);
  pose->timestamp = time;
  m_rawlog.write(*pose);
  for (const auto& o : observations) m_rawlog.write(*o);
}

void DriveLog::writeMovement(mrpt::Clock::time_point time, const Eigen::Isometry3d& T_map_robot) {
  Eigen::Isometry3d movement = Eigen::Isometry3d::Identity();
  if (m_started) movement = disturbed(m_T_map_before.inverse() * T_map_robot, m_noise, m_random);
  m_T_map_before = T_map_robot;
  m_started = true;

  mrpt::obs::CActionRobotMovement3D action;
  action.timestamp = time;
  action.rawOdometryIncrementReading = action.poseChange.mean = toMrpt(movement);
  const double deviation = std::max(1e-3, m_noise * movement.translation().norm());
  for (int i = 0; i < 6; ++i) action.poseChange.cov(i, i) = deviation * deviation;
  mrpt::obs::CActionCollection actions;
  actions.insert(action);
  m_rawlog.write(actions);
}

}  // namespace synthetic_rawlog
