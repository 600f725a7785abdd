#pragma once
#include <synthetic_world/Image.h>
#include <synthetic_world/SensorNoise.h>
#include <synthetic_world/World.h>

namespace synthetic_world {

/** A pinhole camera with depth, color and classes.
 *
 * Camera frame: x ahead along the optical axis, y left, z up. Pixel (row, column) looks along
 * (1, (cx - column) / f, (cy - row) / f); whole numbers are the pixels' centers. */
struct CameraOptions {
  int width = 320, height = 240;  // pixels
  double horizontalFov = 80;      // degrees
  double minRange = 0.3;          // m of depth; nearer returns are lost
  double maxRange = 20;           // m of depth
  bool color = true;              // render the color image, too
  SensorNoise noise;

  double focalLength() const;  // pixels
  double cx() const { return (width - 1) / 2.0; }
  double cy() const { return (height - 1) / 2.0; }
  /** Direction of a pixel with x = 1, camera frame. */
  Eigen::Vector3d ray(double row, double column) const {
    return {1, (cx() - column) / focalLength(), (cy() - row) / focalLength()};
  }
  /** Its own, without the noise, which sensors may share. */
  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field. */
  void validate() const;
};

struct CameraFrame {
  Image<float> depth;     // m along the optical axis; 0: no return
  Image<ClassId> labels;  // kNoClass where there is no return
  Image<Color> color;     // empty if not asked for
};

/** What a camera sees from a pose.
 * \throw std::invalid_argument the options are not valid. */
CameraFrame renderCamera(const World& world, const Eigen::Isometry3d& T_world_camera,
                         const CameraOptions& options, FrameSeed seed = {});

}  // namespace synthetic_world
