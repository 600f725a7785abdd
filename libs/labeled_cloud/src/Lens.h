#pragma once
#include <mrpt/img/TCamera.h>

#include <opencv2/core.hpp>
#include <vector>

namespace labeled_cloud {

/** Pixels of a camera and where they look: x right, y down at depth 1 (the optical frame). */
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
  cv::Vec<double, 8> plumbBob() const;
  cv::Vec4d fisheye() const;

  mrpt::img::TCamera m_camera;
  cv::Matx33d m_K;
};

}  // namespace labeled_cloud
