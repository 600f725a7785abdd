#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <cmath>
#include <random>

#include "PaintedWorld.h"

/** A street that a LiDAR scans as it drives along y, 1.8 m above the ground at x = 0. There are
 * rings, holes between them, and, if wanted, mirrored returns. */
class ScannedStreet {
 public:
  struct Lidar {
    int rings = 32, columns = 720;
    double lowest = -25, highest = 5;  ///< elevation, degrees
  };

  explicit ScannedStreet(double voxelSize) : map(voxelSize, PaintedWorld::classTable()) {}

  /** \param height of the ground, f(x) in meters
   * \param ghosts share of the beams that come back from beyond the ground */
  template <class F>
  void scan(F height, double y, const Lidar& lidar, double ghosts = 0) {
    semantic_types::LabeledCloud cloud;
    std::uniform_real_distribution<double> share(0, 1), beyond(1, 30);
    for (int ring = 0; ring < lidar.rings; ++ring)
      for (int column = 0; column < lidar.columns; ++column) {
        const double up = (lidar.lowest + ring * (lidar.highest - lidar.lowest) / lidar.rings) *
                          M_PI / 180,
                     turn = 2 * M_PI * column / lidar.columns;
        const Eigen::Vector3d beam(std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn),
                                   std::sin(up));
        double range = rangeOf(height, beam);
        if (range == 0) continue;
        const bool isGhost = share(m_random) < ghosts;
        if (isGhost) range += beyond(m_random);
        cloud.points.push_back((range * beam).cast<float>());
        cloud.classes.push_back(isGhost ? semantic_types::kNoClass
                                        : semantic_types::ClassId(PaintedWorld::Road));
      }
    map.insert(cloud, Eigen::Isometry3d(Eigen::Translation3d(0, y, kSensor)));
  }

  semantic_octree::SemanticOcTree map;

 private:
  static constexpr double kSensor = 1.8, kFarthest = 25, kStep = 0.1;  // m

  /** In steps, then by bisection of the last one. 0: nothing is hit. */
  template <class F>
  static double rangeOf(F height, const Eigen::Vector3d& beam) {
    const auto isBelow = [&](double range) {
      return kSensor + range * beam.z() <= height(range * beam.x());
    };
    double low = 1;
    while (low < kFarthest && !isBelow(low + kStep)) low += kStep;
    if (beam.z() >= 0 || low >= kFarthest) return 0;
    for (double step = kStep / 2; step > 1e-3; step /= 2)
      if (!isBelow(low + step)) low += step;
    return low + 1e-3;
  }

  std::mt19937 m_random{11};
};
