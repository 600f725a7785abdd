#pragma once
#include <semantic_types/LabeledCloud.h>
#include <strict_files/OptionList.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/Solids.h>
#include <synthetic_world/World.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace synthetic_world {

using semantic_types::LabeledCloud;

/** Pixels row by row, from the upper left. */
template <class T>
struct Image {
  int width = 0, height = 0;
  std::vector<T> pixels;

  Image() = default;
  Image(int w, int h, T value = T())
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, value) {}
  bool empty() const { return pixels.empty(); }
  T& at(int row, int column) { return pixels[static_cast<std::size_t>(row) * width + column]; }
  const T& at(int row, int column) const {
    return pixels[static_cast<std::size_t>(row) * width + column];
  }
};

/** What a sensor gets wrong. All zero: nothing. */
struct SensorNoise {
  double range = 0;  // standard deviation of ranges and depths, m
  double label = 0;  // share of labels replaced by one of the other classes at random, 0..1

  void describe(strict_files::OptionList& list);

  double disturbed(double meters, Random& random) const {
    return range > 0 ? meters + range * random.normal() : meters;
  }
  ClassId disturbed(ClassId id, Random& random) const;
};

/** Which of the many random choices a sensor makes: the same seed and frame, the same noise. */
struct FrameSeed {
  std::uint64_t seed = 1, frame = 0;
};

/** A pinhole camera with depth, color and classes.
 *
 * Camera frame: x ahead along the optical axis, y left, z up. Pixel (row, column) looks along
 * (1, (cx - column) / f, (cy - row) / f); whole numbers are the pixels' centers. */
struct CameraOptions {
  int width = 320, height = 240;            // pixels
  double horizontalFov = 80;                // degrees
  static constexpr double kMinRange = 0.3;  // m of depth; nearer returns are lost
  double maxRange = 20;                     // m of depth
  bool color = true;                        // render the color image, too
  SensorNoise noise;

  double focalLength() const;  // pixels
  double cx() const { return (width - 1) / 2.0; }
  double cy() const { return (height - 1) / 2.0; }
  /** Direction of a pixel with x = 1, camera frame. */
  Eigen::Vector3d ray(double row, double column) const {
    return {1, (cx() - column) / focalLength(), (cy() - row) / focalLength()};
  }
  /** The options of this sensor, without the noise, which sensors may share. */
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

/** A LiDAR that turns around its z axis. Sensor frame: x ahead, y left, z up. */
struct LidarOptions {
  int rings = 32, columns = 1024;
  double lowest = -25, highest = 15;        // elevation of the first and last ring, degrees
  static constexpr double kMinRange = 0.8;  // m; nearer returns are lost
  double maxRange = 60;                     // m
  /** Share (0..1) of the beams on windows, cars, water and signs that return by way of what these
   * mirror. Such ghosts lie behind the surface, many of them below the ground. */
  double ghosts = 0;
  SensorNoise noise;
  bool keepEmpty = false;  ///< beams that meet nothing have a point without a class at maxRange

  /** Unit vector of a beam, sensor frame; ring 0 is the highest, column 0 looks ahead. */
  Eigen::Vector3d beam(int ring, int column) const;
  /** The options of this sensor, without the noise, which sensors may share. */
  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field. */
  void validate() const;
};

/** Where a LiDAR is when a share of its turn is done, from 0 on. */
using LidarPath = std::function<Eigen::Isometry3d(double share)>;

/** One turn, all beams of a column at once: the returns, ring after ring, in the frame of the
 * sensor when each was taken.
 * \throw std::invalid_argument the options are not valid. */
LabeledCloud scanLidar(const World& world, const LidarPath& T_world_lidar,
                       const LidarOptions& options, FrameSeed seed = {});
/** One turn, taken from a single pose. */
LabeledCloud scanLidar(const World& world, const Eigen::Isometry3d& T_world_lidar,
                       const LidarOptions& options, FrameSeed seed = {});
/** The share of the turn at which each point of such a scan was taken. */
std::vector<float> sharesOfTurn(const LabeledCloud& scan);

}  // namespace synthetic_world
