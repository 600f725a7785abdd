#pragma once
#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace labeled_cloud {

/** Where each pixel of a camera looks, lens distortion taken out: (y, z) at x = 1. x is forward, y
 * to the left, z up (MRPT's frame of depth cameras). */
class PixelRays {
 public:
  /** \throw std::invalid_argument the camera is not calibrated. */
  explicit PixelRays(const mrpt::img::TCamera& camera);

  bool isFor(const mrpt::img::TCamera& camera) const { return camera == m_camera; }
  int rows() const { return static_cast<int>(m_camera.nrows); }
  int cols() const { return static_cast<int>(m_camera.ncols); }

  /** The ray of pixel row * cols() + col. */
  const Eigen::Vector2f& operator[](std::size_t pixel) const { return m_rays[pixel]; }

 private:
  mrpt::img::TCamera m_camera;
  std::vector<Eigen::Vector2f> m_rays;
};

/** A depth image as points in the camera's frame (x forward), one for each pixel. */
struct PointGrid {
  int rows = 0, cols = 0;
  /** rows x cols, row-major, meters. */
  std::vector<Eigen::Vector3f> points;

  PointGrid(int rows_, int cols_)
      : rows(rows_), cols(cols_), points(std::size_t(rows_) * cols_, noReturn()) {}

  static Eigen::Vector3f noReturn() { return Eigen::Vector3f::Constant(NAN); }
  static bool isReturn(const Eigen::Vector3f& p) { return p.allFinite() && !p.isZero(0); }
};

/** \throw std::invalid_argument the range image has another size than its camera's. */
void checkSize(const mrpt::obs::CObservation3DRangeScan& scan);

/** Points of the range image. \param rays of its pixels, as many */
PointGrid unproject(const mrpt::obs::CObservation3DRangeScan& scan, const PixelRays& rays);

/** Removes points that hang between two surfaces at a depth edge. In a row or a column such a point
 * lies strictly between both neighbors in depth, and continues neither side's surface. Slanted
 * surfaces count, too: planes are straight lines in 1/depth along rows and columns.
 * \param threshold what counts as "not the same": a share of the inverse depth.
 * \return number of points removed */
std::size_t removeFlyingPixels(PointGrid& grid, double threshold);

}  // namespace labeled_cloud
