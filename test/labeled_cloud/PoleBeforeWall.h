#pragma once
#include "DepthCamera.h"

/** A pole in front of a wall, class a and b; distances in m. */
constexpr double kPole = 1, kWall = 3;

inline bool onPole(int, int col) { return col >= 23 && col < 30; }

inline mrpt::obs::CObservation3DRangeScan::Ptr poleBeforeWall(const DepthCamera& camera) {
  auto scan = camera.see([](int r, int c) { return onPole(r, c) ? kPole : kWall; });
  camera.label(*scan, [](int r, int c) { return onPole(r, c) ? 1 : 2; });
  return scan;
}
