#pragma once
#include <map_view/CellSource.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace map_view {

struct Ray {
  Eigen::Vector3d origin;     ///< m, map frame
  Eigen::Vector3d direction;  ///< of length 1
};

/** A camera that looks at a point from around it, as MRPT's windows have it. */
struct OrbitCamera {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< m, map frame
  double distance = 40;                              ///< from the target, m
  double azimuth = -120, elevation = 40;  ///< of the camera seen from the target, degrees
  double fieldOfView = 30;                ///< from the picture's bottom to its top, degrees

  Eigen::Vector3d position() const { return target - distance * forward(); }
  Eigen::Vector3d forward() const;
  Eigen::Vector3d right() const;
  Eigen::Vector3d up() const { return right().cross(forward()); }

  /** Pixels per meter at a distance of 1 m. */
  double focalLength(int height) const;
  /** Through the middle of a pixel; (0, 0) is the upper left one. */
  Ray rayThrough(int x, int y, int width, int height) const;
  /** Where a place (m, map frame) is seen, its inverse; none: behind the camera. */
  std::optional<Eigen::Vector2d> pixelOf(const Eigen::Vector3d& place, int width, int height) const;
  /** Whether a ball may be seen in a picture of this size. */
  bool maySee(const Eigen::Vector3d& center, double radius, int width, int height) const;

  /** A camera of this direction, so far away that a box fills the picture. */
  OrbitCamera seeing(const Eigen::AlignedBox3d& box, int width, int height) const;

  /** "X,Y,Z,DISTANCE,AZIMUTH,ELEVATION" */
  std::string text() const;
  /** \throw std::invalid_argument not six numbers, a distance that is not above 0, or an elevation
   * outside -90 to 90. */
  static OrbitCamera ofText(const std::string& text);
};

/** The first cell along a ray that is shown and occupied: what is seen there, down to the finest
 * cell, whatever the view draws together. */
std::optional<ViewCell> firstShown(const CellSource& cells, const CellLook& look, const Ray& ray);

}  // namespace map_view
