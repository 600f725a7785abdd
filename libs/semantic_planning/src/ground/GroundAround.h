#pragma once
#include <semantic_planning/ground/Ground.h>

#include <cmath>
#include <vector>

#include "vehicle/CurveWalk.h"

namespace semantic_planning {

/** Ground near a vehicle. */
struct GroundSample {
  double x, y;  ///< in the vehicle's frame, meters
  double z;     ///< meters
  ClassId classId;
};

/** The footprint and the clearance around it, with some room, in the vehicle's frame. */
Eigen::AlignedBox2d boxAround(const VehicleOptions& vehicle, double voxelSize);

/** f(number of the ray, place in the vehicle's frame, column) along rays from a circle around a box
 * on, in all directions, as long as f says so. */
template <class F>
void forRaysAround(const Ground& ground, const Eigen::AlignedBox2d& box, const Placement& placed,
                   F f) {
  constexpr int kRays = 64;
  constexpr double kFar = 10;  // m: what is farther tells little
  for (int i = 0; i < kRays; ++i) {
    const double to = i * 2 * M_PI / kRays;
    bool goesOn = true;
    for (double r = box.diagonal().norm() / 2; goesOn && r < kFar; r += ground.voxelSize() / 2) {
      const double x = box.center().x() + r * std::cos(to), y = box.center().y() + r * std::sin(to);
      const auto [px, py] = placed(x, y);
      goesOn = f(i, Eigen::Vector2d(x, y), ground.columnAt(px, py));
    }
  }
}

/** Leaves out what is higher or lower than a vehicle on the ground would see: cars' roofs, ghosts.
 * \param z of the ground below the vehicle; none: the samples' median */
void keepLevel(std::vector<GroundSample>& samples, const VehicleOptions& vehicle,
               std::optional<double> z);

bool areAllAround(const std::vector<GroundSample>& samples, const Eigen::Vector2d& center);

/** Coefficients of the plane z = p0 + p1 x + p2 y of least squares. */
Eigen::Vector3d planeThrough(const std::vector<GroundSample>& samples);

}  // namespace semantic_planning
