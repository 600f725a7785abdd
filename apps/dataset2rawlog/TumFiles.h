#pragma once
#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <filesystem>
#include <map>
#include <optional>

namespace dataset2rawlog {

/** Largest difference between a depth image's time and that of what belongs to it, s. */
constexpr double kTimeTolerance = 0.02;

/** Image files by their time in seconds. */
using ImageList = std::map<double, std::filesystem::path>;

/** Reads "time file" lines; the files are relative to the list's folder.
 * \throw std::runtime_error naming file and line. */
ImageList readImageList(const std::filesystem::path& list);

/** The image nearest to a time, within kTimeTolerance. */
std::optional<std::filesystem::path> nearest(const ImageList& images, double time);

struct DepthCamera {
  mrpt::img::TCamera intrinsics;
  /** Value of a depth image's pixel at one meter. */
  double depthFactor = 0;
};

/** Reads camera.ini: MRPT's section [CAMERA_PARAMS] and in it depth_factor.
 * \throw std::runtime_error naming the file and what is missing. */
DepthCamera readCamera(const std::filesystem::path& file);

/** A depth image of 16 bits as an observation.
 * \throw std::runtime_error naming a file that is something else. */
mrpt::obs::CObservation3DRangeScan readDepth(const std::filesystem::path& file,
                                             const DepthCamera& camera);

/** Gives the observation its color image.
 * \throw std::runtime_error naming a file that is no image. */
void addColor(const std::filesystem::path& file, mrpt::obs::CObservation3DRangeScan& scan);

}  // namespace dataset2rawlog
