#include "Lens.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <stdexcept>
#include <string>

namespace labeled_cloud {

using mrpt::img::DistortionModel;
using Points = std::vector<cv::Point2d>;

Lens::Lens(const mrpt::img::TCamera& camera)
    : m_camera(camera), m_K(camera.fx(), 0, camera.cx(), 0, camera.fy(), camera.cy(), 0, 0, 1) {
  if (!(camera.fx() > 0 && camera.fy() > 0))
    throw std::invalid_argument(
        "the camera is not calibrated: fx = " + std::to_string(camera.fx()) +
        ", fy = " + std::to_string(camera.fy()));
}

cv::Vec<double, 8> Lens::plumbBob() const {
  const auto& c = m_camera;
  return {c.k1(), c.k2(), c.p1(), c.p2(), c.k3(), c.k4(), c.k5(), c.k6()};
}

cv::Vec4d Lens::fisheye() const {
  return {m_camera.k1(), m_camera.k2(), m_camera.k3(), m_camera.k4()};
}

Points Lens::undistort(const Points& pixels) const {
  const cv::TermCriteria exact(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-9);
  Points rays;
  if (m_camera.distortion == DistortionModel::plumb_bob)
    cv::undistortPoints(pixels, rays, m_K, plumbBob(), cv::noArray(), cv::noArray(), exact);
  else if (m_camera.distortion == DistortionModel::kannala_brandt)
    cv::fisheye::undistortPoints(pixels, rays, m_K, fisheye());
  else
    cv::undistortPoints(pixels, rays, m_K, cv::noArray());
  return rays;
}

Points Lens::distort(const Points& rays) const {
  Points pixels;
  if (rays.empty()) return pixels;
  if (m_camera.distortion == DistortionModel::kannala_brandt) {
    cv::fisheye::distortPoints(rays, pixels, m_K, fisheye());
    return pixels;
  }
  if (m_camera.distortion == DistortionModel::plumb_bob && plumbBob() != decltype(plumbBob())()) {
    std::vector<cv::Point3d> points;
    for (const cv::Point2d& ray : rays) points.emplace_back(ray.x, ray.y, 1);
    const cv::Vec3d none(0, 0, 0);
    cv::projectPoints(points, none, none, m_K, plumbBob(), pixels);
    return pixels;
  }
  pixels.reserve(rays.size());
  for (const cv::Point2d& ray : rays)
    pixels.emplace_back(m_K(0, 0) * ray.x + m_K(0, 2), m_K(1, 1) * ray.y + m_K(1, 2));
  return pixels;
}

cv::Rect2d Lens::field() const {
  Points border;
  const double right = m_camera.ncols - 0.5, bottom = m_camera.nrows - 0.5;
  for (double u = -0.5; u <= right; u += 1) border.insert(border.end(), {{u, -0.5}, {u, bottom}});
  for (double v = -0.5; v <= bottom; v += 1) border.insert(border.end(), {{-0.5, v}, {right, v}});
  cv::Point2d low(HUGE_VAL, HUGE_VAL), high = -low;
  for (const cv::Point2d& ray : undistort(border)) {
    low = {std::min(low.x, ray.x), std::min(low.y, ray.y)};
    high = {std::max(high.x, ray.x), std::max(high.y, ray.y)};
  }
  return {low, high};
}

}  // namespace labeled_cloud
