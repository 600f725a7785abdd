#pragma once
#include "MapCells.h"

namespace map_pictures {

/** A pinhole camera in the map. */
struct PictureCamera {
  /** Axes of the camera (right, down, forward) as columns, and where it is, m. */
  Eigen::Matrix3d R_map_camera;
  Eigen::Vector3d position;
  /** Pixels; the principal point is the picture's middle. */
  double focalLength;
  int width, height;
  /** Depths between which nearly all cells are, m. */
  double near, far;
};

/** The nearest camera with the viewpoint's direction that sees nearly all of the cells. */
PictureCamera fitCamera(const std::vector<MapCell>& cells, const Viewpoint& viewpoint, int width,
                        int height);

}  // namespace map_pictures
