#pragma once
#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <vector>

namespace labeled_cloud {

/** Where each pixel of a camera looks, lens distortion taken out: (y, z) at x = 1, x forward, y to
 * the left, z up (MRPT's frame of depth cameras). */
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

}  // namespace labeled_cloud
