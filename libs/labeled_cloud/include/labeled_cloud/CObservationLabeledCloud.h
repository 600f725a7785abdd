#pragma once
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CSerializable.h>
#include <mrpt_compat/Release.h>
#include <semantic_types/LabeledCloud.h>

#include <limits>
#include <string>
#include <vector>

namespace labeled_cloud {

/** Points with a class each, as a LiDAR with labels gives them, or a labeled depth image.
 *
 * Any number of classes (1..254), hard or soft labels, or none. Streams into rawlogs without loss:
 * 13 bytes per point with hard labels, before the rawlog's own compression.
 * Programs that read such rawlogs must know the class: see registerObservations(). */
class CObservationLabeledCloud : public mrpt::obs::CObservation {
  DEFINE_SERIALIZABLE(CObservationLabeledCloud, labeled_cloud)
 public:
  /** The points in meters, in the sensor's frame. */
  semantic_types::LabeledCloud cloud;
  /** When each point was taken, seconds after `timestamp`; empty: all then, or nobody knows. 4 more
   * bytes per point in rawlogs. */
  std::vector<float> times;
  /** Points this far from the sensor or farther stand for beams without a return: nothing is
   * nearer.
   * m */
  float emptyFrom = std::numeric_limits<float>::infinity();
  /** T_robot_sensor. */
  mrpt::poses::CPose3D sensorPose;
  /** Name of class i at [i - 1], for people and to tell class tables apart. May be empty. */
  std::vector<std::string> classNames;

  /** \throw std::invalid_argument naming what does not fit: numbers of points, classes,
   * probabilities or times, times that are not finite, class ids above 254 or (where there are
   * names) without one, a range without returns that is not above 0. */
  void validate() const;

#if MSO_MRPT_AT_LEAST(3, 0, 0)
  mrpt::poses::CPose3D getSensorPose() const override { return sensorPose; }
#else
  void getSensorPose(mrpt::poses::CPose3D& out) const override { out = sensorPose; }
#endif
  void setSensorPose(const mrpt::poses::CPose3D& pose) override { sensorPose = pose; }
  using mrpt::obs::CObservation::getSensorPose;
  using mrpt::obs::CObservation::setSensorPose;

  /** Number of points, extent, points per class. */
  void getDescriptionAsText(std::ostream& out) const override;
};

/** Registers this library's observation with MRPT's class factory, so that rawlogs with it can be
 * read. Called when the library is loaded; call it where the linker may drop a library of which
 * nothing else is used. May be called any number of times. */
void registerObservations();

}  // namespace labeled_cloud
