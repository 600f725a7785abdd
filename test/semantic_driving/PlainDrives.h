#pragma once

#include <utility>

#include "Plain.h"
#include "simulated_drive/DriveLoop.h"

/** Drives through worlds that are made for one question. */
namespace plain_drives {

using namespace simulated_drive;
using mrpt::math::TPose2D;
using synthetic_world::World;

inline DriveRecord drive(World& world, const TPose2D& start, const TPose2D& goal,
                         Events events = {}, const DriveConfig& config = smallConfig()) {
  DriveLoop loop(config, world, syntheticOrder(), start, goal, std::move(events));
  return loop.run();
}

/** Flat grass without an end that could be reached in time. */
inline World open() {
  constexpr double kHalf = 60;
  return World(synthetic_world::Terrain(kHalf, {}),
               synthetic_world::GroundCover(kHalf, synthetic_world::kGrass), {});
}

/** Four barriers from the beginning on, a square without a gap.
 * \param half from its middle to each side, m */
inline std::vector<Events::Roadblock> barriersAround(const Eigen::Vector2d& middle, double half) {
  const double length = 2 * half;
  const Eigen::Vector2d x(half, 0), y(0, half);
  return {{0, middle + x, 0, length},
          {0, middle - x, 0, length},
          {0, middle + y, M_PI / 2, length},
          {0, middle - y, M_PI / 2, length}};
}

}  // namespace plain_drives
