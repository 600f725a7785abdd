#pragma once
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>

#include <optional>

#include "Conversion.h"
#include "Progress.h"
#include "label_noise/LabelNoise.h"

namespace dataset2rawlog {

/** The rawlog being written: poses and labeled clouds, with the label noise applied. */
class Output {
 public:
  /** The conversion must outlive it. */
  Output(const Conversion& conversion, const semantic_types::ClassTable& table);

  /** Whether a frame is to be converted; says on the way how far that is.
   * \param numFrames of the data set, wanted or not; 0: nobody knows */
  bool wants(std::size_t frame, std::size_t numFrames = 0);

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
  const Conversion& m_conversion;
  labeled_cloud::RawlogWriter m_writer;
  LabelNoise m_noise;
  Eigen::Isometry3d m_T_map_sensor = Eigen::Isometry3d::Identity();  ///< of the last pose
  std::vector<std::string> m_classNames;
  Summary m_summary;
  std::optional<Progress> m_progress;
};

}  // namespace dataset2rawlog
