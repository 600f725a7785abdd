#pragma once
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/system/COutputLogger.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

namespace semantic_map {

/** T_map_sensor as Eigen knows it. \throw std::invalid_argument a pose is not finite. */
inline Eigen::Isometry3d sensorPose(const mrpt::poses::CPose3D& T_map_robot,
                                    const mrpt::poses::CPose3D& T_robot_sensor) {
  const auto finite = [](const mrpt::poses::CPose3D& pose, const char* whose) {
    const Eigen::Isometry3d T = labeled_cloud::toEigen(pose);
    if (!T.matrix().allFinite())
      throw std::invalid_argument(std::string("the pose of the ") + whose + " is not finite");
    return T;
  };
  return finite(T_map_robot, "robot") * finite(T_robot_sensor, "sensor");
}

/** A converter and what it was made for: it keeps the rays of the camera met last. */
struct CachedConverter {
  CachedConverter(const semantic_types::ClassTable& table_,
                  const labeled_cloud::ScanConverterOptions& options_)
      : table(table_), options(options_), converter(table_, options_) {}

  bool isFor(const semantic_types::ClassTable& t,
             const labeled_cloud::ScanConverterOptions& o) const {
    const auto &labels = o.labels, &known = options.labels;
    return o.decimation == options.decimation &&
           o.flyingPixelThreshold == options.flyingPixelThreshold &&
           o.emptyCarves == options.emptyCarves &&
           o.occlusionParallax == options.occlusionParallax && labels.kind == known.kind &&
           labels.minConfidence == known.minConfidence && labels.confusion == known.confusion &&
           t == table;
  }

  semantic_types::ClassTable table;
  labeled_cloud::ScanConverterOptions options;
  labeled_cloud::ScanConverter converter;
};

/** Keeps the scan of the observation whose likelihood was asked for last. Particle filters ask at
 * many poses, some from several threads. */
class LikelihoodCache {
 public:
  /** The observation's scan; null if it cannot be used. The reason goes to the logger as a warning,
   * unless it is the same as the last. Safe to call from several threads. */
  std::shared_ptr<const labeled_cloud::LabeledScan> scanOf(
      const mrpt::obs::CObservation& observation, const semantic_types::ClassTable& classes,
      const labeled_cloud::ScanConverterOptions& options, mrpt::system::COutputLogger& logger);
  /** Forgets the scan, and what it depends on. */
  void clear();

 private:
  void convert(const mrpt::obs::CObservation& observation, mrpt::system::COutputLogger& logger);

  std::mutex m_mutex;
  std::unique_ptr<CachedConverter> m_converter;
  /** Fingerprint of the observation that m_scan was made of; none without a converter. */
  std::uint64_t m_fingerprint = 0;
  std::shared_ptr<const labeled_cloud::LabeledScan> m_scan;
  std::string m_refusal;
};

}  // namespace semantic_map
