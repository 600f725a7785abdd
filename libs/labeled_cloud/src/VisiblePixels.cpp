#include <labeled_cloud/Pictures.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "Lens.h"

namespace labeled_cloud {

namespace {

/** Surfaces are taken to pass the camera no nearer than this, m. */
constexpr double kClearance = 1.0;
/** Nearer points are not projected, m. */
constexpr float kNearest = 0.01f;

/** A point within the image. */
struct Candidate {
  std::uint32_t point;
  cv::Point2f pixel;
  float inverseDepth;
};

std::vector<Candidate> inImage(const std::vector<Eigen::Vector3f>& points,
                               const Eigen::Isometry3d& T_camera_points,
                               const mrpt::img::TCamera& camera) {
  const Lens lens(camera);
  const cv::Rect2d field = lens.field();
  const Eigen::Isometry3f T = T_camera_points.cast<float>();
  std::vector<cv::Point2d> rays;
  std::vector<Candidate> candidates;
  rays.reserve(points.size()), candidates.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f p = T * points[i];
    if (!(p.z() > kNearest)) continue;
    const cv::Point2d ray(p.x() / p.z(), p.y() / p.z());
    if (!field.contains(ray)) continue;
    rays.push_back(ray);
    candidates.push_back({static_cast<std::uint32_t>(i), {}, 1 / p.z()});
  }
  const auto pixels = lens.distort(rays);
  for (std::size_t i = 0; i < pixels.size(); ++i) candidates[i].pixel = pixels[i];
  const cv::Rect2f image(-0.5f, -0.5f, float(camera.ncols), float(camera.nrows));
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                  [&](const Candidate& c) { return !image.contains(c.pixel); }),
                   candidates.end());
  return candidates;
}

/** Cells of an image, each with the greatest inverse depth of the points around it. */
class DepthBuffer {
 public:
  DepthBuffer(const std::vector<Candidate>& candidates, const mrpt::img::TCamera& camera)
      : m_edge(spacing(candidates, camera)) {
    m_nearest = cv::Mat1f::zeros(int(camera.nrows / m_edge) + 1, int(camera.ncols / m_edge) + 1);
    for (const Candidate& c : candidates) {
      float& nearest = m_nearest(cell(c));
      nearest = std::max(nearest, c.inverseDepth);
    }
    cv::dilate(m_nearest, m_nearest, cv::Mat());
  }

  /** How far from a point those may be that it is compared with, pixels. */
  double reach() const { return 2.0 * m_edge; }
  float nearestAround(const Candidate& c) const { return m_nearest(cell(c)); }

 private:
  /** Mean distance of the points in the part of the image that they cover, in whole pixels. */
  static float spacing(const std::vector<Candidate>& candidates, const mrpt::img::TCamera& camera) {
    constexpr int kBlock = 16;
    cv::Mat1b covered =
        cv::Mat1b::zeros(int(camera.nrows) / kBlock + 1, int(camera.ncols) / kBlock + 1);
    for (const Candidate& c : candidates)
      covered(int(c.pixel.y + 0.5) / kBlock, int(c.pixel.x + 0.5) / kBlock) = 1;
    const double pixels = double(kBlock) * kBlock * cv::countNonZero(covered);
    return std::max(1.f, std::round(float(std::sqrt(pixels / double(candidates.size())))));
  }

  cv::Point cell(const Candidate& c) const {
    return {int((c.pixel.x + 0.5f) / m_edge), int((c.pixel.y + 0.5f) / m_edge)};
  }

  float m_edge;
  cv::Mat1f m_nearest;
};

void removeHidden(const mrpt::img::TCamera& camera, double baseline, double parallax,
                  std::vector<Candidate>& candidates) {
  const DepthBuffer buffer(candidates, camera);
  const double step = std::max(parallax / baseline, buffer.reach() / kClearance) /
                      std::min(camera.fx(), camera.fy());
  const auto hidden = [&](const Candidate& c) {
    return buffer.nearestAround(c) > c.inverseDepth + step;
  };
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(), hidden), candidates.end());
}

}  // namespace

std::vector<Eigen::Vector2f> visiblePixels(const std::vector<Eigen::Vector3f>& points,
                                           const Eigen::Isometry3d& T_camera_points,
                                           const mrpt::img::TCamera& camera, double parallax) {
  auto candidates = inImage(points, T_camera_points, camera);
  const double baseline = T_camera_points.translation().norm();
  if (parallax > 0 && baseline > 0 && !candidates.empty())
    removeHidden(camera, baseline, parallax, candidates);
  std::vector<Eigen::Vector2f> pixels(points.size(), Eigen::Vector2f::Constant(NAN));
  for (const Candidate& c : candidates) pixels[c.point] = {c.pixel.x, c.pixel.y};
  return pixels;
}

}  // namespace labeled_cloud
