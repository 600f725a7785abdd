#pragma once
#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>
#include <strict_files/OptionList.h>

#include <optional>
#include <string>

namespace labeled_cloud {

/** What is known of a camera beside what its observations say, and counts instead of that. */
struct CameraCalibration {
  std::optional<mrpt::img::TCamera> intrinsics;
  /** The optical frame: x right, y down, z forward. */
  std::optional<mrpt::poses::CPose3D> T_robot_camera;
};

/** A calibration as files have it: the optics, or the pose, may be left out as a whole. */
struct CameraDescription {
  enum class Distortion { PlumbBob, KannalaBrandt };

  std::optional<double> cols, rows, fx, fy, cx, cy;  ///< pixels
  Distortion distortion = Distortion::PlumbBob;
  /** Its coefficients in MRPT's order, separated by spaces. */
  std::string dist;
  std::optional<double> x, y, z;           ///< of the optical frame in the robot's, m
  std::optional<double> yaw, pitch, roll;  ///< degrees

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming an option that is missing, or what is no coefficient. */
  CameraCalibration calibration() const;
};
const strict_files::Choices<CameraDescription::Distortion>& choicesOf(
    CameraDescription::Distortion);

}  // namespace labeled_cloud
