#pragma once
#include <mrpt/img/CImage.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

namespace labeled_cloud {

/** A color (or gray) image of an observation, with the camera that took it. */
struct ColorImage {
  /** Shares its pixels with the observation; may be stored in a file of its own. */
  mrpt::img::CImage image;
  mrpt::img::TCamera camera;
  /** The camera's optical frame: x right, y down, z forward. */
  mrpt::poses::CPose3D T_robot_camera;
};

/** Whether observations of this class are nothing but pictures: CObservationImage and
 * CObservationStereoImages (of which the left image counts). */
bool isPicture(const mrpt::obs::CObservation& observation);

/** The color image of a picture, or of a CObservation3DRangeScan that has one.
 * \throw std::invalid_argument the observation has none. */
ColorImage colorImageOf(const mrpt::obs::CObservation& observation);

}  // namespace labeled_cloud
