#include <semantic_planning/vehicle/ReedsShepp.h>

#include <strict_files/OptionList.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "ReedsSheppWords.h"

namespace semantic_planning {

using mrpt::math::TPose2D;

namespace {

constexpr double kTurn = 2 * M_PI;
constexpr double kSameTurn =
    1e-9;  // arcs that only rounding keeps from being none, or a whole turn

/** Into [0, a whole turn). */
double positive(double angle) {
  const double turned = angle - kTurn * std::floor(angle / kTurn);
  return turned > kTurn - kSameTurn ? 0 : turned;
}

/** Solves words for curves that begin with an arc to the left; those that begin to the right are
 * their mirror images. */
class ForwardSearch {
 public:
  void offerBoth(const TPose2D& from, const TPose2D& to) {
    const double dx = to.x - from.x, dy = to.y - from.y;
    const double c = std::cos(from.phi), s = std::sin(from.phi);
    const double ahead = c * dx + s * dy, left = c * dy - s * dx, turn = to.phi - from.phi;
    offer(ahead, left, turn, 1);
    offer(ahead, -left, -turn, -1);
  }
  const Word& shortest() const { return m_shortest; }

 private:
  /** To a goal that is so far ahead and to the left. \param side 1, or -1 in the mirror. */
  void offer(double ahead, double left, double turn, int side) {
    straightToSameSide(ahead - std::sin(turn), left + std::cos(turn) - 1, turn, side);
    const double x = ahead + std::sin(turn), y = left - std::cos(turn) - 1;
    straightToOtherSide(x, y, turn, side);
  }

  /** LSL, and LRL. \param x, y from the first circle's center to the last one's */
  void straightToSameSide(double x, double y, double turn, int side) {
    const double distance = std::hypot(x, y), direction = std::atan2(y, x);
    const double first = positive(direction);
    keep({first, distance, positive(turn - first)}, {side, 0, side});
    if (distance > 4) return;
    const double half = std::acos(distance / 4);  // at the first center, to the middle one's
    const double begin = positive(direction + half + M_PI / 2), middle = M_PI + 2 * half;
    keep({begin, middle, positive(turn - begin + middle)}, {side, -side, side});
  }

  /** LSR. */
  void straightToOtherSide(double x, double y, double turn, int side) {
    const double distance2 = x * x + y * y;
    if (distance2 < 4) return;
    const double straight = std::sqrt(distance2 - 4);
    const double first = positive(std::atan2(y, x) + std::atan2(2, straight));
    keep({first, straight, positive(first - turn)}, {side, 0, -side});
  }

  void keep(const std::array<double, 3>& lengths, const std::array<int, 3>& turns) {
    const double length = lengths[0] + lengths[1] + lengths[2];
    if (length >= m_length) return;
    m_length = length;
    m_shortest = {};
    for (std::size_t i = 0; i < 3; ++i) m_shortest[i] = {turns[i], lengths[i]};
  }

  double m_length = std::numeric_limits<double>::infinity();
  Word m_shortest{};
};

/** The shortest of the six words of Dubins (1957), which only go forward, between two poses,
 * turning radius 1. */
Word shortestForwardWord(const TPose2D& from, const TPose2D& to) {
  ForwardSearch search;
  search.offerBoth(from, to);
  return search.shortest();
}

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
