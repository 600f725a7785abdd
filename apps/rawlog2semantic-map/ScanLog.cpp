#include "ScanLog.h"

#include <labeled_cloud/CObservationLabeledCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>

namespace rawlog2semantic_map {

ScanLog::ScanLog(const std::filesystem::path& file, const semantic_types::ClassTable& classes)
    : m_writer(file) {
  for (int id = 1; id <= classes.size(); ++id)
    m_classNames.push_back(classes.name(static_cast<semantic_types::ClassId>(id)));
}

void ScanLog::write(const labeled_cloud::LabeledScan& scan,
                    const mrpt::poses::CPose3D& T_map_robot) {
  mrpt::obs::CObservationRobotPose pose;
  pose.timestamp = scan.timestamp;
  pose.sensorLabel = "robot";
  pose.pose.mean = T_map_robot;
  m_writer.write(pose);
  labeled_cloud::CObservationLabeledCloud cloud;
  cloud.timestamp = scan.timestamp;
  cloud.sensorLabel = scan.sensorLabel;
  cloud.sensorPose = scan.T_robot_sensor;
  cloud.classNames = m_classNames;
  cloud.cloud = scan.cloud;
  m_writer.write(cloud);
}

}  // namespace rawlog2semantic_map
