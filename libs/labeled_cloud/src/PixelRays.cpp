#include "PixelRays.h"

#include "Lens.h"

namespace labeled_cloud {

PixelRays::PixelRays(const mrpt::img::TCamera& camera) : m_camera(camera) {
  std::vector<cv::Point2d> pixels;
  pixels.reserve(std::size_t(camera.nrows) * camera.ncols);
  for (unsigned row = 0; row < camera.nrows; ++row)
    for (unsigned col = 0; col < camera.ncols; ++col) pixels.emplace_back(col, row);
  m_rays.reserve(pixels.size());
  for (const cv::Point2d& ray : Lens(camera).undistort(pixels))
    m_rays.emplace_back(static_cast<float>(-ray.x), static_cast<float>(-ray.y));
}

}  // namespace labeled_cloud
