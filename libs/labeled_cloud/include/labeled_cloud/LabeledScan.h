#pragma once
#include <labeled_cloud/LabelImage.h>
#include <mrpt/core/Clock.h>
#include <mrpt/img/CImage.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>
#include <semantic_types/LabeledCloud.h>

#include <cstddef>
#include <string>
#include <vector>

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

/** A picture that points took their labels from. */
struct LabeledPicture {
  /** Empty if there is no color image of the label image's view. */
  mrpt::img::CImage image;
  LabelImage labels;
  mrpt::img::TCamera camera;
  /** The camera's optical frame (x right, y down, z forward) when the picture was taken, in that of
   * the sensor when it saw the points. */
  mrpt::poses::CPose3D T_sensor_camera;
};

/** One observation, ready for a map. */
struct LabeledScan {
  /** Points in the sensor's frame, all finite. */
  semantic_types::LabeledCloud cloud;
  mrpt::poses::CPose3D T_robot_sensor;
  mrpt::Clock::time_point timestamp;
  std::string sensorLabel;
  ScanCounts counts;
  /** A labeler was asked and had no labels for this observation. */
  bool labelsMissing = false;
  /** Where the labels come from, if that was asked for. */
  std::vector<LabeledPicture> pictures;

  /** Brings counts.labeled up to date. */
  void countLabels();
};

}  // namespace labeled_cloud
