#include "PointGrid.h"

#include <stdexcept>

namespace labeled_cloud {

using mrpt::obs::CObservation3DRangeScan;

namespace {

std::string size(long rows, long cols) {
  return std::to_string(cols) + " x " + std::to_string(rows);
}

}  // namespace

PointGrid unproject(const CObservation3DRangeScan& scan, const PixelRays& rays) {
  const auto& image = scan.rangeImage;
  PointGrid grid(static_cast<int>(image.rows()), static_cast<int>(image.cols()));
  if (grid.rows != rays.rows() || grid.cols != rays.cols())
    throw std::invalid_argument("the range image has " + size(grid.rows, grid.cols) +
                                " pixels, but its camera is calibrated for " +
                                size(rays.rows(), rays.cols()));
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
  const int rows = static_cast<int>(scan.cameraParams.nrows);
  const int cols = static_cast<int>(scan.cameraParams.ncols);
  const bool indexed = count > 0 && scan.points3D_idxs_x.size() == count;
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

/** Inverse depths along one row or column. */
class Line {
 public:
  Line(const std::vector<float>& w, std::size_t first, std::size_t step, int length)
      : m_w(w), m_first(first), m_step(step), m_length(length) {}

  /** Inverse depth, NaN outside the image and where nothing was seen. */
  float operator[](int i) const { return i < 0 || i >= m_length ? NAN : m_w[m_first + i * m_step]; }

 private:
  const std::vector<float>& m_w;
  std::size_t m_first, m_step;
  int m_length;
};

/** Whether pixel i continues the surface on the side of SIDE (-1 or 1): as near as its neighbor, or
 * on the plane through the next three pixels. */
bool continues(const Line& w, int i, int side, float tolerance) {
  const float here = w[i], a = w[i + side], b = w[i + 2 * side], c = w[i + 3 * side];
  if (std::abs(here - a) <= tolerance) return true;
  return std::abs(here - 2 * a + b) <= tolerance && std::abs(a - 2 * b + c) <= tolerance;
}

bool isFlying(const Line& w, int i, float threshold) {
  const float here = w[i], tolerance = threshold * here;
  if (!((here - w[i - 1]) * (w[i + 1] - here) > 0)) return false;  // also where one is missing
  return !continues(w, i, -1, tolerance) && !continues(w, i, 1, tolerance);
}

}  // namespace

std::size_t removeFlyingPixels(PointGrid& grid, double threshold) {
  std::vector<float> inverse(grid.points.size());
  for (std::size_t i = 0; i < inverse.size(); ++i) inverse[i] = 1 / grid.points[i].x();

  std::size_t removed = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int col = 0; col < grid.cols; ++col) {
      const Line alongRow(inverse, std::size_t(row) * grid.cols, 1, grid.cols);
      const Line alongColumn(inverse, col, grid.cols, grid.rows);
      if (!isFlying(alongRow, col, static_cast<float>(threshold)) &&
          !isFlying(alongColumn, row, static_cast<float>(threshold)))
        continue;
      grid.points[std::size_t(row) * grid.cols + col] = PointGrid::noReturn();
      ++removed;
    }
  return removed;
}

}  // namespace labeled_cloud
