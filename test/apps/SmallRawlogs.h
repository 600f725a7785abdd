#pragma once
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <filesystem>
#include <vector>

/** Three classes: 1 road, 2 grass, 3 car. */
inline const char* const kSmallTable =
    "classes:\n"
    "  - {id: 1, name: road, color: [255, 0, 0]}\n"
    "  - {id: 2, name: grass, color: [0, 255, 0]}\n"
    "  - {id: 3, name: car, color: [0, 0, 255]}\n";

inline mrpt::Clock::time_point at(double seconds) { return mrpt::Clock::fromDouble(seconds); }

inline mrpt::obs::CObservationRobotPose robotPose(double seconds, double x) {
  mrpt::obs::CObservationRobotPose pose;
  pose.timestamp = at(seconds);
  pose.pose.mean.x(x);
  return pose;
}

/** A cloud of the class names above, seen from the robot's origin. */
inline labeled_cloud::CObservationLabeledCloud labeledCloud(
    double seconds, const std::vector<Eigen::Vector3f>& points,
    const std::vector<semantic_types::ClassId>& classes) {
  labeled_cloud::CObservationLabeledCloud observation;
  observation.timestamp = at(seconds);
  observation.sensorLabel = "lidar";
  observation.classNames = {"road", "grass", "car"};
  observation.cloud.points = points;
  observation.cloud.classes = classes;
  return observation;
}

/** A wall at 2 m ahead, without labels of its own. */
inline mrpt::obs::CObservation3DRangeScan depthImage(double seconds, int rows, int cols) {
  mrpt::obs::CObservation3DRangeScan scan;
  scan.timestamp = at(seconds);
  scan.sensorLabel = "camera";
  scan.hasRangeImage = true;
  scan.rangeImage_setSize(rows, cols);
  scan.rangeImage.fill(2000);
  scan.rangeUnits = 0.001f;
  scan.range_is_depth = true;
  scan.cameraParams.nrows = rows;
  scan.cameraParams.ncols = cols;
  scan.cameraParams.setIntrinsicParamsFromValues(cols, cols, cols / 2.0, rows / 2.0);
  return scan;
}

/** Writes a rawlog of these observations. */
template <typename... Observations>
std::filesystem::path writeSmallRawlog(const std::filesystem::path& file,
                                       const Observations&... observations) {
  labeled_cloud::RawlogWriter writer(file);
  (writer.write(observations), ...);
  writer.finish();
  return file;
}
