#pragma once
#include <mrpt/img/TCamera.h>

#include <Eigen/Geometry>
#include <vector>

namespace labeled_cloud {

/** The pixel (column, row) at which a camera sees each point; NaN for points that it does not see:
 * outside of the image, behind the camera, not finite, or hidden.
 *
 * A point may be hidden where the points were not measured from where the camera is, at the
 * distance b: two points at depths z and Z on one ray of the camera are b f (1/z - 1/Z) pixels
 * apart, seen from the sensor. A point is hidden if another one within twice the points' spacing of
 * it in the image is nearer by more than PARALLAX such pixels (one that is nearer by less leaves no
 * more than that along its edge), and by more than a surface that passes the camera at one meter
 * changes within that distance. \param T_camera_points The camera's optical frame: x right, y down,
 * z forward. \param parallax pixels; 0: nothing is hidden. \throw std::invalid_argument the camera
 * is not calibrated. */
std::vector<Eigen::Vector2f> visiblePixels(const std::vector<Eigen::Vector3f>& points,
                                           const Eigen::Isometry3d& T_camera_points,
                                           const mrpt::img::TCamera& camera, double parallax);

}  // namespace labeled_cloud
