#include "Observations.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt_compat/Images.h>

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

using mrpt::obs::CObservation3DRangeScan;
using synthetic_world::ClassTable;

mrpt::obs::CObservationRobotPose::Ptr robotPose(const Eigen::Isometry3d& T_map_robot) {
  auto pose = mrpt::obs::CObservationRobotPose::Create();
  pose->sensorLabel = "ROBOT";
  pose->pose.mean = toMrpt(T_map_robot);
  return pose;
}

namespace {

/** Blue, green, red. */
cv::Mat3b pictureOf(const synthetic_world::Image<synthetic_world::Color>& image) {
  cv::Mat3b result(image.height, image.width);
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const synthetic_world::Color c = image.at(row, column);
      result(row, column) = {c.b, c.g, c.r};
    }
  return result;
}

mrpt::obs::TPixelLabelInfoBase::Ptr labelBits(
    const synthetic_world::Image<synthetic_world::ClassId>& labels, const ClassTable& classes) {
  using Bits = mrpt::obs::TPixelLabelInfo<4>;
  static_assert(kMostPixelClasses < 32);
  auto bits = std::make_shared<Bits>();
  bits->setSize(labels.height, labels.width);
  for (int row = 0; row < labels.height; ++row)
    for (int column = 0; column < labels.width; ++column)
      if (const auto id = labels.at(row, column)) bits->setLabel(row, column, id);
  for (synthetic_world::ClassId id = 1; id <= classes.size(); ++id)
    bits->setLabelName(id, classes.name(id));
  return bits;
}

mrpt::img::TCamera calibration(const synthetic_world::CameraOptions& options) {
  mrpt::img::TCamera camera;
  camera.ncols = static_cast<uint32_t>(options.width);
  camera.nrows = static_cast<uint32_t>(options.height);
  const double f = options.focalLength();
  camera.setIntrinsicParamsFromValues(f, f, options.cx(), options.cy());
  return camera;
}

}  // namespace

CObservation3DRangeScan::Ptr rangeScan(const synthetic_world::CameraFrame& frame,
                                       const synthetic_world::CameraOptions& options,
                                       const Eigen::Isometry3d& T_robot_camera,
                                       const ClassTable& classes) {
  auto scan = CObservation3DRangeScan::Create();
  scan->sensorLabel = "CAMERA";
  scan->sensorPose = toMrpt(T_robot_camera);
  scan->hasRangeImage = true;
  scan->range_is_depth = true;
  scan->rangeUnits = 0.001f;
  scan->maxRange = static_cast<float>(options.maxRange);
  scan->stdError = static_cast<float>(options.noise.range);
  scan->rangeImage_setSize(options.height, options.width);
  for (int row = 0; row < options.height; ++row)
    for (int column = 0; column < options.width; ++column)
      scan->rangeImage(row, column) =
          static_cast<uint16_t>(std::lround(1000 * frame.depth.at(row, column)));
  scan->cameraParams = scan->cameraParamsIntensity = calibration(options);
  scan->pixelLabels = labelBits(frame.labels, classes);
  scan->hasIntensityImage = true;
  scan->intensityImage = mrpt_compat::toMrpt(pictureOf(frame.color));
  return scan;
}

labeled_cloud::CObservationLabeledCloud::Ptr labeledCloud(synthetic_world::LabeledCloud cloud,
                                                          const Eigen::Isometry3d& T_robot_lidar,
                                                          const ClassTable& classes) {
  auto observation = labeled_cloud::CObservationLabeledCloud::Create();
  observation->sensorLabel = "LIDAR";
  observation->sensorPose = toMrpt(T_robot_lidar);
  observation->cloud = std::move(cloud);
  for (synthetic_world::ClassId id = 1; id <= classes.size(); ++id)
    observation->classNames.push_back(classes.name(id));
  return observation;
}

}  // namespace synthetic_rawlog
