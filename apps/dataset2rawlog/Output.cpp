#include "Output.h"

#include <labeled_cloud/Trajectory.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <algorithm>
#include <stdexcept>

namespace dataset2rawlog {

using semantic_types::kNoClass;

Output::Output(const Conversion& conversion, const semantic_types::ClassTable& table)
    : m_conversion(conversion),
      m_writer(conversion.output),
      m_noise(conversion.labelNoise, conversion.labelNoiseKind, conversion.seed, table.size()) {
  for (int id = 1; id <= table.size(); ++id) m_classNames.push_back(table.name(id));
}

bool Output::wants(std::size_t frame, std::size_t numFrames) {
  const FrameRange& range = m_conversion.frames;
  const std::size_t end = numFrames == 0 ? 0 : std::min(numFrames - 1, range.last) + 1;
  if (!m_progress) m_progress.emplace("Converting", end);
  m_progress->update(frame, std::to_string(m_summary.scans) + " scans");
  return range.contains(frame) && !(m_conversion.stop && m_conversion.stop->pending());
}

void Output::writePose(mrpt::Clock::time_point time, const mrpt::poses::CPose3D& T_map_robot) {
  mrpt::obs::CObservationRobotPose pose;
  pose.timestamp = time;
  pose.sensorLabel = "ground truth";
  pose.pose.mean = T_map_robot;
  m_T_map_sensor = labeled_cloud::toEigen(T_map_robot);
  m_writer.write(pose);
}

void Output::writeCloud(mrpt::Clock::time_point time, const std::string& sensorLabel,
                        semantic_types::LabeledCloud cloud) {
  labeled_cloud::CObservationLabeledCloud observation;
  observation.timestamp = time;
  observation.sensorLabel = sensorLabel;
  observation.classNames = m_classNames;
  observation.cloud = std::move(cloud);
  m_noise.apply(observation.cloud, m_T_map_sensor);
  const auto& classes = observation.cloud.classes;
  const auto unlabeled = std::count(classes.begin(), classes.end(), kNoClass);
  writeScan(observation, observation.cloud.size(), classes.size() - unlabeled);
}

void Output::writeScan(const mrpt::obs::CObservation& observation, std::size_t points,
                       std::size_t labeled) {
  m_writer.write(observation);
  ++m_summary.scans;
  m_summary.points += points;
  m_summary.labeled += labeled;
}

Summary Output::finish() {
  if (m_summary.scans == 0)
    throw std::runtime_error(m_conversion.output.string() + ": not written, no frame was selected");
  m_progress.reset();
  m_writer.finish();
  return m_summary;
}

}  // namespace dataset2rawlog
