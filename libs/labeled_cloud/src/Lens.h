#pragma once
#include <mrpt/img/TCamera.h>

#include <opencv2/core.hpp>
#include <vector>

namespace labeled_cloud {

/** Pixels of a camera and where they look: x right, y down at depth 1 (the optical frame). Lenses
 * are as OpenCV and MRPT describe them: plumb_bob with radial coefficients k1 to k6 and tangential
 * ones p1 and p2, or kannala_brandt with k1 to k4. */
class Lens {
 public:
  /** \throw std::invalid_argument the camera is not calibrated. */
  explicit Lens(const mrpt::img::TCamera& camera);

  std::vector<cv::Point2d> undistort(const std::vector<cv::Point2d>& pixels) const;
  /** For rays that the camera sees: models of lenses say nothing about others. */
  std::vector<cv::Point2d> distort(const std::vector<cv::Point2d>& rays) const;

  /** A rectangle that holds all rays of the image's pixels. */
  cv::Rect2d field() const;

 private:
  /** Between a ray without a lens and behind it, both at depth 1. */
  cv::Point2d bent(const cv::Point2d& ray) const;
  cv::Point2d straightened(const cv::Point2d& ray) const;
  double radial(double r2) const;
  cv::Point2d tangential(const cv::Point2d& ray) const;
  /** The angle behind a fisheye lens of a ray that comes in at an angle theta, radians. */
  double fisheyeAngle(double theta) const;

  mrpt::img::TCamera m_camera;
};

}  // namespace labeled_cloud
