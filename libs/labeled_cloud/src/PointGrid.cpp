#include "PointGrid.h"

#include <labeled_cloud/Pictures.h>
#include <strict_files/OptionList.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace labeled_cloud {

using mrpt::img::DistortionModel;
using mrpt::obs::CObservation3DRangeScan;

namespace {

using ImagePoints = std::vector<cv::Point2d>;

/** Pixels of a camera and where they look: x right, y down at depth 1 (the optical frame). Lenses
 * are as OpenCV and MRPT describe them: plumb_bob with radial coefficients k1 to k6 and tangential
 * ones p1 and p2. */
class Lens {
 public:
  /** \throw std::invalid_argument the camera is not calibrated, or has a fisheye. */
  explicit Lens(const mrpt::img::TCamera& camera) : m_camera(camera) {
    if (!(camera.fx() > 0 && camera.fy() > 0))
      throw std::invalid_argument(
          "the camera is not calibrated: fx = " + strict_files::textOf(camera.fx()) +
          ", fy = " + strict_files::textOf(camera.fy()));
    if (camera.distortion == DistortionModel::kannala_brandt)
      throw std::invalid_argument(
          "the camera has a fisheye (kannala_brandt), expected images without its distortion");
  }

  ImagePoints undistort(ImagePoints pixels) const {
    const double perX = 1 / m_camera.fx(), perY = 1 / m_camera.fy();
    for (cv::Point2d& p : pixels)
      p = straightened({(p.x - m_camera.cx()) * perX, (p.y - m_camera.cy()) * perY});
    return pixels;
  }
  /** For rays that the camera sees: models of lenses say nothing about others. */
  cv::Point2d pixelOf(const cv::Point2d& ray) const {
    const cv::Point2d p = bent(ray);
    return {m_camera.fx() * p.x + m_camera.cx(), m_camera.fy() * p.y + m_camera.cy()};
  }

  /** A rectangle that holds all rays of the image's pixels. */
  cv::Rect2d field() const {
    ImagePoints border;
    const double right = m_camera.ncols - 0.5, bottom = m_camera.nrows - 0.5;
    for (double u = -0.5; u <= right; u += 1) border.insert(border.end(), {{u, -0.5}, {u, bottom}});
    for (double v = -0.5; v <= bottom; v += 1) border.insert(border.end(), {{-0.5, v}, {right, v}});
    cv::Point2d low(HUGE_VAL, HUGE_VAL), high = -low;
    for (const cv::Point2d& ray : undistort(std::move(border))) {
      low = {std::min(low.x, ray.x), std::min(low.y, ray.y)};
      high = {std::max(high.x, ray.x), std::max(high.y, ray.y)};
    }
    return {low, high};
  }

 private:
  bool isPlain() const { return m_camera.distortion != DistortionModel::plumb_bob; }
  /** Between a ray without a lens and behind it, both at depth 1. */
  cv::Point2d bent(const cv::Point2d& ray) const {
    return isPlain() ? ray : ray * radial(ray.dot(ray)) + tangential(ray);
  }
  /** By fixed-point iteration. */
  cv::Point2d straightened(const cv::Point2d& ray) const {
    constexpr int kMostSteps = 50;
    constexpr double kExact = 1e-9;  // of a pixel
    cv::Point2d straight = ray;
    for (int i = 0; i < kMostSteps && !isPlain(); ++i) {
      straight = (ray - tangential(straight)) / radial(straight.dot(straight));
      const cv::Point2d left = bent(straight) - ray;
      if (std::hypot(left.x * m_camera.fx(), left.y * m_camera.fy()) < kExact) break;
    }
    return straight;
  }
  double radial(double r2) const {
    const auto& c = m_camera;
    return (1 + ((c.k3() * r2 + c.k2()) * r2 + c.k1()) * r2) /
           (1 + ((c.k6() * r2 + c.k5()) * r2 + c.k4()) * r2);
  }
  cv::Point2d tangential(const cv::Point2d& ray) const {
    const double r2 = ray.dot(ray), xy2 = 2 * ray.x * ray.y;
    return {m_camera.p1() * xy2 + m_camera.p2() * (r2 + 2 * ray.x * ray.x),
            m_camera.p1() * (r2 + 2 * ray.y * ray.y) + m_camera.p2() * xy2};
  }

  mrpt::img::TCamera m_camera;
};

}  // namespace

PixelRays::PixelRays(const mrpt::img::TCamera& camera) : m_camera(camera) {
  ImagePoints pixels;
  pixels.reserve(std::size_t(camera.nrows) * camera.ncols);
  for (unsigned row = 0; row < camera.nrows; ++row)
    for (unsigned col = 0; col < camera.ncols; ++col) pixels.emplace_back(col, row);
  m_rays.reserve(pixels.capacity());
  for (const cv::Point2d& ray : Lens(camera).undistort(std::move(pixels)))
    m_rays.emplace_back(static_cast<float>(-ray.x), static_cast<float>(-ray.y));
}

void checkSize(const CObservation3DRangeScan& scan) {
  const auto& image = scan.rangeImage;
  const mrpt::img::TCamera& camera = scan.cameraParams;
  const auto size = [](auto cols, auto rows) {
    return std::to_string(cols) + " x " + std::to_string(rows);
  };
  if (std::size_t(image.rows()) != camera.nrows || std::size_t(image.cols()) != camera.ncols)
    throw std::invalid_argument("the range image has " + size(image.cols(), image.rows()) +
                                " pixels, but its camera is calibrated for " +
                                size(camera.ncols, camera.nrows));
}

PointGrid unproject(const CObservation3DRangeScan& scan, const PixelRays& rays) {
  const auto& image = scan.rangeImage;
  PointGrid grid(static_cast<int>(image.rows()), static_cast<int>(image.cols()));
  const std::uint16_t* range = image.data();
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    if (range[i] == 0) continue;
    const Eigen::Vector3f direction(1, rays[i].x(), rays[i].y());
    const float r = range[i] * scan.rangeUnits;
    grid.points[i] = direction * (scan.range_is_depth ? r : r / direction.norm());
  }
  return grid;
}

namespace {

/** How far removeFlyingPixels() looks around a pixel. */
constexpr int kReach = 3;

/** Inverse depths, NaN where nothing was seen and in a border of kReach pixels around the image. */
struct InverseDepths {
  std::size_t stride;
  std::vector<float> values;

  explicit InverseDepths(const PointGrid& grid)
      : stride(grid.cols + 2 * kReach), values(stride * (grid.rows + 2 * kReach), NAN) {
    for (int row = 0; row < grid.rows; ++row)
      for (int col = 0; col < grid.cols; ++col)
        values[index(row, col)] = 1 / grid.points[std::size_t(row) * grid.cols + col].x();
  }
  std::size_t index(int row, int col) const { return (row + kReach) * stride + col + kReach; }
};

/** Whether the pixel at W continues the surface STEP beside it: as near as its neighbor, or on the
 * plane through the next three. */
bool continues(const float* w, std::ptrdiff_t step, float tolerance) {
  const float here = w[0], a = w[step], b = w[2 * step], c = w[3 * step];
  if (std::abs(here - a) <= tolerance) return true;
  return std::abs(here - 2 * a + b) <= tolerance && std::abs(a - 2 * b + c) <= tolerance;
}

/** Along the line of pixels that are STEP apart. */
bool isFlying(const float* w, std::ptrdiff_t step, float threshold) {
  if (!((w[0] - w[-step]) * (w[step] - w[0]) > 0)) return false;  // also where one is missing
  const float tolerance = threshold * w[0];
  return !continues(w, -step, tolerance) && !continues(w, step, tolerance);
}

}  // namespace

std::size_t removeFlyingPixels(PointGrid& grid, double threshold) {
  const InverseDepths inverse(grid);
  const auto share = static_cast<float>(threshold);
  const auto down = static_cast<std::ptrdiff_t>(inverse.stride);
  std::size_t removed = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int col = 0; col < grid.cols; ++col) {
      const float* w = &inverse.values[inverse.index(row, col)];
      if (!isFlying(w, 1, share) && !isFlying(w, down, share)) continue;
      grid.points[std::size_t(row) * grid.cols + col] = PointGrid::noReturn();
      ++removed;
    }
  return removed;
}

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
  const cv::Rect2f image(-0.5f, -0.5f, float(camera.ncols), float(camera.nrows));
  std::vector<Candidate> candidates;
  candidates.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f p = T * points[i];
    if (!(p.z() > kNearest)) continue;
    const cv::Point2d ray(p.x() / p.z(), p.y() / p.z());
    if (!field.contains(ray)) continue;
    const cv::Point2f pixel = lens.pixelOf(ray);
    if (image.contains(pixel))
      candidates.push_back({static_cast<std::uint32_t>(i), pixel, 1 / p.z()});
  }
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
