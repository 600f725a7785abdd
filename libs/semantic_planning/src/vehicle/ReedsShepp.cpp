#include <semantic_planning/vehicle/ReedsShepp.h>

#include <algorithm>
#include <cmath>

#include <strict_files/OptionList.h>

#include <stdexcept>
#include "DubinsWords.h"
#include "ReedsSheppWords.h"

namespace semantic_planning {

using mrpt::math::TPose2D;

namespace {

constexpr double kNoLength = 1e-9;  // m: sums of segments' lengths are not exact

/** Where `s` meters (negative: backwards) along a segment lead. */
TPose2D advance(const TPose2D& p, int turn, double s, double radius) {
  if (turn == 0) return {p.x + s * std::cos(p.phi), p.y + s * std::sin(p.phi), p.phi};
  const double phi = p.phi + turn * s / radius;
  return {p.x + turn * radius * (std::sin(phi) - std::sin(p.phi)),
          p.y - turn * radius * (std::cos(phi) - std::cos(p.phi)), std::remainder(phi, 2 * M_PI)};
}

}  // namespace

ReedsSheppCurve::ReedsSheppCurve(const TPose2D& from, double turningRadius,
                                 const std::array<Segment, 5>& segments)
    : m_from(from), m_radius(turningRadius), m_segments(segments), m_length(0) {
  for (const Segment& segment : segments) m_length += std::abs(segment.length);
}

CurvePoint ReedsSheppCurve::at(double s) const {
  CurvePoint point{m_from};
  double left = std::clamp(s, 0.0, m_length);
  for (const Segment& segment : m_segments) {
    if (segment.length == 0) continue;
    const double length = std::min(left, std::abs(segment.length));
    point.pose = advance(point.pose, segment.turn, std::copysign(length, segment.length), m_radius);
    point.curvature = segment.turn / m_radius;
    point.forward = segment.length > 0;
    left -= length;
    if (left <= kNoLength) break;
  }
  return point;
}

ReedsSheppCurve ReedsSheppCurve::reversed() const {
  std::array<Segment, 5> segments;
  std::reverse_copy(m_segments.begin(), m_segments.end(), segments.begin());
  for (Segment& segment : segments) segment.length = -segment.length;
  return {at(m_length).pose, m_radius, segments};
}

ReedsShepp::ReedsShepp(double turningRadius) : m_radius(turningRadius) {
  if (!(turningRadius > 0) || !std::isfinite(turningRadius))
    throw std::invalid_argument("ReedsShepp: turning radius is " +
                                strict_files::textOf(turningRadius) + ", expected above 0");
}

TPose2D ReedsShepp::scaled(const TPose2D& pose) const {
  return {pose.x / m_radius, pose.y / m_radius, pose.phi};
}

double ReedsShepp::distance(const TPose2D& a, const TPose2D& b) const {
  return m_radius * shortestWordLength(scaled(a), scaled(b));
}

double ReedsShepp::lowerBound(const TPose2D& a, const TPose2D& b) const {
  return std::max(std::hypot(b.x - a.x, b.y - a.y),
                  m_radius * std::abs(std::remainder(b.phi - a.phi, 2 * M_PI)));
}

ReedsSheppCurve ReedsShepp::connect(const TPose2D& a, const TPose2D& b) const {
  return curveOf(a, shortestWord(scaled(a), scaled(b)));
}

ReedsSheppCurve ReedsShepp::connectForward(const TPose2D& a, const TPose2D& b) const {
  return curveOf(a, shortestForwardWord(scaled(a), scaled(b)));
}

ReedsSheppCurve ReedsShepp::curveOf(const TPose2D& from, const Word& word) const {
  std::array<ReedsSheppCurve::Segment, 5> segments;
  for (std::size_t i = 0; i < word.size(); ++i)
    segments[i] = {m_radius * word[i].length, word[i].turn};
  return {from, m_radius, segments};
}

}  // namespace semantic_planning
