#include "CameraFit.h"

#include <algorithm>
#include <cmath>

namespace map_pictures {
namespace {

constexpr double kRadians = M_PI / 180;
/** Horizontal angle of view: little perspective, so that distances compare. */
constexpr double kAngleOfView = 40 * kRadians;
/** Share of the picture that stays free at each side. */
constexpr double kBorder = 0.03;
/** Cells beyond it on each side of the picture may be cut off. */
constexpr double kFar = 0.001;

Eigen::Matrix3d orientation(const Viewpoint& viewpoint) {
  const double h = viewpoint.heading * kRadians, t = viewpoint.tilt * kRadians;
  const Eigen::Vector3d forward(std::cos(t) * std::cos(h), std::cos(t) * std::sin(h), -std::sin(t));
  const Eigen::Vector3d right(std::sin(h), -std::cos(h), 0);
  Eigen::Matrix3d R;
  R << right, forward.cross(right), forward;
  return R;
}

/** Along one axis of the picture: the least distance D at which all points (s sideways, d deep)
 * obey |s - offset| <= slope (d + D), and the offset. */
struct AxisFit {
  double distance, offset;
};
AxisFit fitAxis(const std::vector<Eigen::Vector3d>& points, int axis, double slope) {
  std::vector<double> values(points.size());
  const auto extreme = [&](double sign) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const Eigen::Vector3d& p) { return sign * p[axis] - slope * p.z(); });
    return quantile(values, 1 - kFar);
  };
  const double right = extreme(+1), left = -extreme(-1);
  return {(right - left) / (2 * slope), (right + left) / 2};
}

}  // namespace

PictureCamera fitCamera(const std::vector<MapCell>& cells, const Viewpoint& viewpoint, int width,
                        int height) {
  PictureCamera camera;
  camera.R_map_camera = orientation(viewpoint);
  camera.width = width, camera.height = height;
  camera.focalLength = width / 2.0 / std::tan(kAngleOfView / 2);

  std::vector<Eigen::Vector3d> points;
  for (const MapCell& cell : cells)
    points.push_back(camera.R_map_camera.transpose() * cell.center.cast<double>());
  const double slope = (1 - 2 * kBorder) / camera.focalLength;
  const AxisFit horizontal = fitAxis(points, 0, slope * width / 2);
  const AxisFit vertical = fitAxis(points, 1, slope * height / 2);

  std::vector<double> depths(points.size());
  std::transform(points.begin(), points.end(), depths.begin(), [](const auto& p) { return p.z(); });
  const double nearest = quantile(depths, kFar), farthest = quantile(depths, 1 - kFar);
  const double size = cells.front().size;
  const double distance = std::max({horizontal.distance, vertical.distance, 2 * size - nearest});
  camera.position =
      camera.R_map_camera * Eigen::Vector3d(horizontal.offset, vertical.offset, -distance);
  camera.near = std::max(0.1 * size, 0.2 * (nearest + distance));
  camera.far = 3 * (farthest + distance) + size;
  return camera;
}

}  // namespace map_pictures
