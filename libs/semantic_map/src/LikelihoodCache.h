#pragma once
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>

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

/** The scan of the observation whose likelihood was asked for last. Particle filters ask at many
 * poses, some from several threads. */
struct LikelihoodCache {
  std::mutex mutex;
  std::unique_ptr<CachedConverter> converter;
  std::string source;  ///< the observation as archives have it; empty: no scan
  std::shared_ptr<const labeled_cloud::LabeledScan> scan;
  std::string refusal;  ///< that was said last
};

}  // namespace semantic_map
