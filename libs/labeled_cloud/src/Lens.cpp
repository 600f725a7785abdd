#include "Lens.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace labeled_cloud {

using mrpt::img::DistortionModel;
using Points = std::vector<cv::Point2d>;

Lens::Lens(const mrpt::img::TCamera& camera) : m_camera(camera) {
  if (!(camera.fx() > 0 && camera.fy() > 0))
    throw std::invalid_argument(
        "the camera is not calibrated: fx = " + std::to_string(camera.fx()) +
        ", fy = " + std::to_string(camera.fy()));
}

double Lens::radial(double r2) const {
  const auto& c = m_camera;
  return (1 + ((c.k3() * r2 + c.k2()) * r2 + c.k1()) * r2) /
         (1 + ((c.k6() * r2 + c.k5()) * r2 + c.k4()) * r2);
}

cv::Point2d Lens::tangential(const cv::Point2d& ray) const {
  const double r2 = ray.dot(ray), xy2 = 2 * ray.x * ray.y;
  return {m_camera.p1() * xy2 + m_camera.p2() * (r2 + 2 * ray.x * ray.x),
          m_camera.p1() * (r2 + 2 * ray.y * ray.y) + m_camera.p2() * xy2};
}

double Lens::fisheyeAngle(double theta) const {
  const double t2 = theta * theta;
  const auto& c = m_camera;
  return theta * (1 + (((c.k4() * t2 + c.k3()) * t2 + c.k2()) * t2 + c.k1()) * t2);
}

cv::Point2d Lens::bent(const cv::Point2d& ray) const {
  if (m_camera.distortion == DistortionModel::plumb_bob)
    return ray * radial(ray.dot(ray)) + tangential(ray);
  const double r = std::hypot(ray.x, ray.y);
  if (m_camera.distortion != DistortionModel::kannala_brandt || r == 0) return ray;
  return ray * (fisheyeAngle(std::atan(r)) / r);
}

/** By fixed-point iteration, and for a fisheye by bisection of the angle, which grows with that
 * behind the lens. */
cv::Point2d Lens::straightened(const cv::Point2d& ray) const {
  if (m_camera.distortion == DistortionModel::plumb_bob) {
    constexpr int kMostSteps = 50;
    constexpr double kExact = 1e-9;  // of a pixel
    cv::Point2d straight = ray;
    for (int i = 0; i < kMostSteps; ++i) {
      straight = (ray - tangential(straight)) / radial(straight.dot(straight));
      const cv::Point2d left = bent(straight) - ray;
      if (std::hypot(left.x * m_camera.fx(), left.y * m_camera.fy()) < kExact) break;
    }
    return straight;
  }
  const double r = std::hypot(ray.x, ray.y);
  if (m_camera.distortion != DistortionModel::kannala_brandt || r == 0) return ray;
  double low = 0, high = M_PI / 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (fisheyeAngle(middle) < r ? low : high) = middle;
  }
  return ray * (std::tan(low) / r);
}

Points Lens::undistort(const Points& pixels) const {
  const double perX = 1 / m_camera.fx(), perY = 1 / m_camera.fy();
  Points rays;
  rays.reserve(pixels.size());
  for (const cv::Point2d& p : pixels)
    rays.push_back(straightened({(p.x - m_camera.cx()) * perX, (p.y - m_camera.cy()) * perY}));
  return rays;
}

Points Lens::distort(const Points& rays) const {
  Points pixels;
  pixels.reserve(rays.size());
  for (const cv::Point2d& ray : rays) {
    const cv::Point2d p = bent(ray);
    pixels.emplace_back(m_camera.fx() * p.x + m_camera.cx(), m_camera.fy() * p.y + m_camera.cy());
  }
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
