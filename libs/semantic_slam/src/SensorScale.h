#pragma once
#include <semantic_types/LabeledCloud.h>

#include <cmath>
#include <vector>

namespace semantic_slam {

using semantic_types::LabeledCloud;

constexpr double kDegree = M_PI / 180;

/** Lengths that follow from the sensor: horizontal beams or beams in space, and how far its returns
 * are. Rooms ask for finer ones than streets. */
struct SensorScale {
  bool isPlanar = true;
  double keyframeDistance = 0;  ///< m; a keyframe begins so far from the one before
  double keyframeAngle = 0;     ///< radians; or turned by so much
  int submapKeyframes = 0;    ///< a scan is registered to so many keyframes, at most twice as many
  double cube = 0;            ///< m; of the points in such a cube one is kept
  double registeredCube = 0;  ///< m; of the points in such a cube one is registered
  std::vector<double> cells;  ///< m; edges of a submap's cubes, coarse ones first
  double gridCell = 0;        ///< m; of the grids in which loops are searched
  double loopLength = 0;      ///< m; least way between a loop's ends
  double leastMatched = 0;    ///< share of points that fit at a loop's other end

  /** \param cloud a scan in the robot's frame */
  static SensorScale of(const LabeledCloud& cloud, bool isPlanar);
};

}  // namespace semantic_slam
