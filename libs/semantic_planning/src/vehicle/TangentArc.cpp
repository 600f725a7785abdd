#include "TangentArc.h"

#include <cmath>

namespace semantic_planning {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

constexpr double kLeastCurvature = 1e-7;  // 1/m: less is none

TPoint2D leftOf(double heading) { return {-std::sin(heading), std::cos(heading)}; }
double dot(const TPoint2D& a, const TPoint2D& b) { return a.x * b.x + a.y * b.y; }
double wrapped(double angle) { return std::remainder(angle, 2 * M_PI); }

TPoint2D centerOf(const TPose2D& pose, double curvature) {
  return TPoint2D(pose.x, pose.y) + leftOf(pose.phi) * (1 / curvature);
}

/** Oriented circles touch if their centers are as far apart as their signed radii differ, a circle
 * and a line if its center is its signed radius to the left. Both are linear in the curvature. */
std::optional<double> curvatureInto(const TPose2D& from, const Arc& into) {
  const TPoint2D left = leftOf(from.phi), point(from.x, from.y);
  double above = 0, below = 0;
  if (into.curvature == 0) {
    const TPoint2D side = leftOf(into.begin.phi);
    above = 1 - dot(left, side);
    below = dot(point - TPoint2D(into.begin.x, into.begin.y), side);
  } else {
    const TPoint2D offset = point - centerOf(into.begin, into.curvature);
    const double radius = 1 / into.curvature;
    above = 2 * (dot(left, offset) + radius);
    below = radius * radius - dot(offset, offset);
  }
  if (std::abs(below) < 1e-9) return std::nullopt;
  const double curvature = above / below;
  return std::abs(curvature) < kLeastCurvature ? 0 : curvature;
}

/** The heading of both where they meet. */
double headingWhereTheyMeet(const TPose2D& from, double curvature, const Arc& into) {
  if (into.curvature == 0) return into.begin.phi;
  if (curvature == 0) return from.phi;
  const TPoint2D apart = centerOf(from, curvature) - centerOf(into.begin, into.curvature);
  const double sign = 1 / curvature < 1 / into.curvature ? -1 : 1;
  return std::atan2(-sign * apart.x, sign * apart.y);
}

double along(const TPose2D& from, const TPose2D& to) {
  return std::cos(from.phi) * (to.x - from.x) + std::sin(from.phi) * (to.y - from.y);
}

}  // namespace

TPose2D Arc::at(double s) const {
  const double phi = begin.phi + curvature * s;
  if (curvature == 0) return {begin.x + s * std::cos(phi), begin.y + s * std::sin(phi), begin.phi};
  return {begin.x + (std::sin(phi) - std::sin(begin.phi)) / curvature,
          begin.y - (std::cos(phi) - std::cos(begin.phi)) / curvature, wrapped(phi)};
}

std::optional<TangentArc> tangentArc(const TPose2D& from, const Arc& into) {
  constexpr double kMostTurn = 1.5 * M_PI, kGap = 1e-5;  // radians, m
  const auto curvature = curvatureInto(from, into);
  if (!curvature) return std::nullopt;
  const double heading = headingWhereTheyMeet(from, *curvature, into);
  TangentArc found{{from, *curvature, 0}, 0};
  if (into.curvature != 0) found.meets = wrapped(heading - into.begin.phi) / into.curvature;
  if (*curvature == 0) {
    found.arc.length = along(from, into.at(found.meets));
  } else {
    double turn = wrapped(heading - from.phi);
    if (turn * *curvature < 0) turn += std::copysign(2 * M_PI, *curvature);
    if (std::abs(turn) > kMostTurn) return std::nullopt;
    found.arc.length = turn / *curvature;
  }
  const TPose2D end = found.arc.at(found.arc.length);
  if (into.curvature == 0) found.meets = along(into.begin, end);
  const TPose2D met = into.at(found.meets);
  if (found.arc.length <= 0 || std::hypot(end.x - met.x, end.y - met.y) > kGap) return std::nullopt;
  return found;
}

}  // namespace semantic_planning
