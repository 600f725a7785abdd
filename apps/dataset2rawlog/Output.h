#pragma once
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>

#include "Conversion.h"
#include "label_noise/LabelNoise.h"

namespace dataset2rawlog {

/** The rawlog being written: poses and labeled clouds, with the label noise applied. */
class Output {
 public:
  Output(const Conversion& conversion, const semantic_types::ClassTable& table);

  /** Adds the robot's pose at a time. */
  void writePose(mrpt::Clock::time_point time, const mrpt::poses::CPose3D& T_map_robot);

  /** Adds a cloud seen from the robot's origin, after its labels took the noise. */
  void writeCloud(mrpt::Clock::time_point time, const std::string& sensorLabel,
                  semantic_types::LabeledCloud cloud);

  /** Adds another observation of so many points, whose labels took the noise already. */
  void writeScan(const mrpt::obs::CObservation& observation, std::size_t points,
                 std::size_t labeled);

  /** Adds what is no scan, as a picture. */
  void writeOther(const mrpt::obs::CObservation& observation) { m_writer.write(observation); }

  void skip() { ++m_summary.skipped; }
  LabelNoise& noise() { return m_noise; }

  /** Completes the file. \throw std::runtime_error not a single scan was written. */
  Summary finish();

 private:
  labeled_cloud::RawlogWriter m_writer;
  LabelNoise m_noise;
  Eigen::Isometry3d m_T_map_sensor = Eigen::Isometry3d::Identity();  ///< of the last pose
  std::vector<std::string> m_classNames;
  std::filesystem::path m_file;
  Summary m_summary;
};

}  // namespace dataset2rawlog
