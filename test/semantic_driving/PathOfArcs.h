#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_driving/DrivePath.h>

#include <cmath>
#include <utility>
#include <vector>

/** A path from the origin along x, a point each 0.1 m, forward.
 * \param arcs their lengths (m) and curvatures (1/m) */
inline semantic_driving::DrivePath pathOfArcs(const std::vector<std::pair<double, double>>& arcs) {
  constexpr double kStep = 0.1;  // m
  std::vector<semantic_planning::PathPoint> points;
  mrpt::math::TPose2D begin(0, 0, 0);
  const auto after = [&begin](double s, double curvature) {
    const double turn = s * curvature;
    return begin + (turn == 0 ? mrpt::math::TPose2D(s, 0, 0)
                              : mrpt::math::TPose2D(std::sin(turn) / curvature,
                                                    (1 - std::cos(turn)) / curvature, turn));
  };
  for (const auto& [length, curvature] : arcs) {
    for (double s = 0; s < length; s += kStep) {
      const auto pose = after(s, curvature);
      points.push_back({pose.x, pose.y, 0, pose.phi, curvature, true, 0, 0});
    }
    begin = after(length, curvature);
  }
  points.push_back({begin.x, begin.y, 0, begin.phi, arcs.back().second, true, 0, 0});
  return semantic_driving::DrivePath(points);
}
