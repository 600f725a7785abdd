#pragma once
#include <semantic_planning/vehicle/ReedsShepp.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace semantic_planning {

struct Rotation {
  explicit Rotation(double angle) : cosine(std::cos(angle)), sine(std::sin(angle)) {}
  double cosine, sine;
};

/** A pose that takes points of the vehicle into the map's frame. */
struct Placement {
  explicit Placement(const mrpt::math::TPose2D& pose) : x(pose.x), y(pose.y), heading(pose.phi) {}

  /** \param px, py in the vehicle's frame, meters */
  std::array<double, 2> operator()(double px, double py) const {
    return {x + heading.cosine * px - heading.sine * py,
            y + heading.sine * px + heading.cosine * py};
  }

  double x, y;  ///< meters, map frame
  Rotation heading;
};

/** Goes along a segment of a curve. */
class SegmentWalk {
 public:
  SegmentWalk(const Placement& begin, const ReedsSheppCurve::Segment& segment, double turningRadius)
      : m_begin(begin),
        m_gear(segment.length < 0 ? -1 : 1),
        m_radius(segment.turn * turningRadius) {}

  /** \param s meters from where the segment begins */
  Placement at(double s) const {
    if (m_radius != 0) return turned(m_begin, Rotation(m_gear * s / m_radius));
    Placement p = m_begin;
    p.x += m_gear * s * p.heading.cosine;
    p.y += m_gear * s * p.heading.sine;
    return p;
  }

  /** f(placement, how many pieces are left) in the middle of pieces `first` to `end` - 1 of a
   * curve. It returns how many pieces to go on by, at most those that are left, or 0: no farther.
   * \param before what the curve has of length before this segment \return whether it came to
   * its end */
  template <class F>
  bool visit(int first, int end, double piece, double before, F f) const {
    const auto middle = [&](int i) { return at((i + 0.5) * piece - before); };
    const Rotation turn(m_radius == 0 ? 0 : m_gear * piece / m_radius);
    Placement p = middle(first);
    while (first < end) {
      const int pieces = f(p, end - first);
      if (pieces == 0) return false;
      first += pieces;
      if (m_radius == 0)
        p = middle(first);
      else
        for (int i = 0; i < pieces; ++i) p = turned(p, turn);
    }
    return true;
  }

 private:
  /** Further along the arc. */
  Placement turned(Placement p, const Rotation& r) const {
    const auto [cosine, sine] = p.heading;
    p.heading.cosine = cosine * r.cosine - sine * r.sine;
    p.heading.sine = sine * r.cosine + cosine * r.sine;
    p.x += m_radius * (p.heading.sine - sine);
    p.y -= m_radius * (p.heading.cosine - cosine);
    return p;
  }

  const Placement m_begin;
  const double m_gear, m_radius;  ///< radius: positive to the left, 0: straight
};

/** Goes along a curve. It calls atMiddle(placement, pieces left) in the middle of pieces of one
 * length, and atEnd(placement) where segments end. The first false ends it. atMiddle returns how
 * many pieces to go on by, see SegmentWalk::visit(). Computes sines for segments, not for
 * pieces. */
template <class AtMiddle, class AtEnd>
bool walkCurve(const ReedsSheppCurve& curve, int pieces, AtMiddle atMiddle, AtEnd atEnd) {
  const double piece = curve.length() / pieces;
  Placement place(curve.from());
  double before = 0;
  int first = 0;
  for (const ReedsSheppCurve::Segment& segment : curve.segments()) {
    const double length = std::abs(segment.length);
    if (length == 0) continue;
    const SegmentWalk walk(place, segment, curve.turningRadius());
    const int end = std::min(pieces, static_cast<int>(std::ceil((before + length) / piece - 0.5)));
    if (first < end && !walk.visit(first, end, piece, before, atMiddle)) return false;
    place = walk.at(length);
    if (!atEnd(place)) return false;
    before += length;
    first = std::max(first, end);
  }
  for (; first < pieces; ++first)
    if (!atMiddle(place, 1)) return false;
  return true;
}

}  // namespace semantic_planning
