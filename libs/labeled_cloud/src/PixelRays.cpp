#include "PixelRays.h"

#include <opencv2/calib3d.hpp>
#include <stdexcept>

namespace labeled_cloud {

using mrpt::img::DistortionModel;
using mrpt::img::TCamera;

namespace {

/** (x right, y down) at depth 1 of every pixel. */
std::vector<cv::Point2d> undistorted(const TCamera& c, const std::vector<cv::Point2d>& pixels) {
  const cv::Matx33d K(c.fx(), 0, c.cx(), 0, c.fy(), c.cy(), 0, 0, 1);
  std::vector<cv::Point2d> rays;
  switch (c.distortion) {
    case DistortionModel::plumb_bob: {
      const cv::Vec<double, 8> D(c.k1(), c.k2(), c.p1(), c.p2(), c.k3(), c.k4(), c.k5(), c.k6());
      const cv::TermCriteria exact(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-9);
      cv::undistortPoints(pixels, rays, K, D, cv::noArray(), cv::noArray(), exact);
      return rays;
    }
    case DistortionModel::kannala_brandt:
      cv::fisheye::undistortPoints(pixels, rays, K, cv::Vec4d(c.k1(), c.k2(), c.k3(), c.k4()));
      return rays;
    default:
      cv::undistortPoints(pixels, rays, K, cv::noArray());
      return rays;
  }
}

}  // namespace

PixelRays::PixelRays(const TCamera& camera) : m_camera(camera) {
  if (!(camera.fx() > 0 && camera.fy() > 0))
    throw std::invalid_argument(
        "the depth camera is not calibrated: fx = " + std::to_string(camera.fx()) +
        ", fy = " + std::to_string(camera.fy()));
  std::vector<cv::Point2d> pixels;
  pixels.reserve(std::size_t(camera.nrows) * camera.ncols);
  for (unsigned row = 0; row < camera.nrows; ++row)
    for (unsigned col = 0; col < camera.ncols; ++col) pixels.emplace_back(col, row);
  m_rays.reserve(pixels.size());
  for (const cv::Point2d& ray : undistorted(camera, pixels))
    m_rays.emplace_back(static_cast<float>(-ray.x), static_cast<float>(-ray.y));
}

}  // namespace labeled_cloud
