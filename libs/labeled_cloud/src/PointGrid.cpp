#include "PointGrid.h"

#include <stdexcept>

#include "Lens.h"

namespace labeled_cloud {

using mrpt::obs::CObservation3DRangeScan;

PixelRays::PixelRays(const mrpt::img::TCamera& camera) : m_camera(camera) {
  std::vector<cv::Point2d> pixels;
  pixels.reserve(std::size_t(camera.nrows) * camera.ncols);
  for (unsigned row = 0; row < camera.nrows; ++row)
    for (unsigned col = 0; col < camera.ncols; ++col) pixels.emplace_back(col, row);
  m_rays.reserve(pixels.size());
  for (const cv::Point2d& ray : Lens(camera).undistort(pixels))
    m_rays.emplace_back(static_cast<float>(-ray.x), static_cast<float>(-ray.y));
}

namespace {

std::string size(long rows, long cols) {
  return std::to_string(cols) + " x " + std::to_string(rows);
}

}  // namespace

void checkSize(const CObservation3DRangeScan& scan) {
  const auto& image = scan.rangeImage;
  const mrpt::img::TCamera& camera = scan.cameraParams;
  if (std::size_t(image.rows()) != camera.nrows || std::size_t(image.cols()) != camera.ncols)
    throw std::invalid_argument("the range image has " + size(image.rows(), image.cols()) +
                                " pixels, but its camera is calibrated for " +
                                size(camera.nrows, camera.ncols));
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

PointGrid gridOfPoints(const CObservation3DRangeScan& scan) {
  const std::size_t count = scan.points3D_x.size();
  const auto check = [count](const char* what, std::size_t number) {
    if (number != count)
      throw std::invalid_argument(std::to_string(number) + " " + what + " for " +
                                  std::to_string(count) + " 3D points");
  };
  check("y", scan.points3D_y.size());
  check("z", scan.points3D_z.size());
  if (!scan.points3D_idxs_x.empty()) {
    check("columns", scan.points3D_idxs_x.size());
    check("rows", scan.points3D_idxs_y.size());
  }
  const int rows = static_cast<int>(scan.cameraParams.nrows);
  const int cols = static_cast<int>(scan.cameraParams.ncols);
  const bool indexed = count > 0 && !scan.points3D_idxs_x.empty();
  const bool organized = indexed || count == std::size_t(rows) * cols;
  PointGrid grid(organized ? rows : 1, organized ? cols : static_cast<int>(count));
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t pixel = i;
    if (indexed) {
      const int row = scan.points3D_idxs_y[i], col = scan.points3D_idxs_x[i];
      if (row >= rows || col >= cols)
        throw std::invalid_argument("a 3D point at pixel row " + std::to_string(row) + ", column " +
                                    std::to_string(col) + " of an image of " + size(rows, cols));
      pixel = std::size_t(row) * cols + col;
    }
    grid.points[pixel] = {scan.points3D_x[i], scan.points3D_y[i], scan.points3D_z[i]};
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

/** Whether the pixel at W continues the surface that begins STEP beside it: as near as its
 * neighbor, or on the plane through the next three pixels. */
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

}  // namespace labeled_cloud
