#pragma once
#include <mrpt/core/Clock.h>
#include <mrpt/poses/CPose3D.h>
#include <semantic_octree/LabeledCloud.h>

#include <cstddef>
#include <string>

namespace labeled_cloud {

/** What became of an observation's pixels or points. */
struct ScanCounts {
  /** Points in the cloud, and those of them with a class. */
  std::size_t points = 0, labeled = 0;
  /** Pixels or points without a usable range: zero, NaN, infinite. */
  std::size_t invalid = 0;
  /** Points left out because they hang in the air at a depth edge. */
  std::size_t flying = 0;
};

/** One observation, ready for a map. */
struct LabeledScan {
  /** Points in the sensor's frame, all finite. */
  semantic_octree::LabeledCloud cloud;
  mrpt::poses::CPose3D T_robot_sensor;
  mrpt::Clock::time_point timestamp;
  std::string sensorLabel;
  ScanCounts counts;
  /** A labeler was asked and had no labels for this observation. */
  bool labelsMissing = false;
};

}  // namespace labeled_cloud
