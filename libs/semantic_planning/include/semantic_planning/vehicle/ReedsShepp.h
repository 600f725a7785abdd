#pragma once
#include <mrpt/math/TPose2D.h>

#include <array>

namespace semantic_planning {

/** A place on a curve. */
struct CurvePoint {
  mrpt::math::TPose2D pose;  ///< meters, radians
  double curvature = 0;      ///< 1/m, of the steering: positive to the left, whatever the gear
  bool forward = true;
};

/** A shortest curve of up to five arcs and straights (Reeds, Shepp, "Optimal paths for a car that
 * goes both forwards and backwards", 1990). */
class ReedsSheppCurve {
 public:
  struct Segment {
    double length = 0;  ///< meters; negative: backwards
    int turn = 0;       ///< 1: left, 0: straight, -1: right
  };

  ReedsSheppCurve(const mrpt::math::TPose2D& from, double turningRadius,
                  const std::array<Segment, 5>& segments);

  const mrpt::math::TPose2D& from() const { return m_from; }
  double turningRadius() const { return m_radius; }  ///< meters
  double length() const { return m_length; }         ///< meters
  /** \param s arc length from the start, clamped to [0, length()], meters. */
  CurvePoint at(double s) const;
  /** The curve driven from its end to its start. */
  ReedsSheppCurve reversed() const;
  const std::array<Segment, 5>& segments() const { return m_segments; }

 private:
  mrpt::math::TPose2D m_from;
  double m_radius;
  std::array<Segment, 5> m_segments;
  double m_length;
};

/** Finds shortest curves. */
class ReedsShepp {
 public:
  /** \throw std::invalid_argument radius not positive. */
  explicit ReedsShepp(double turningRadius);

  double turningRadius() const { return m_radius; }
  /** Length of the shortest curve, meters: a metric, and the same in both directions to the bit. */
  double distance(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) const;
  /** A lower bound of distance() that costs next to nothing. */
  double lowerBound(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) const;
  /** A shortest curve. Where there are several, as left-right-left and right-left-right with two
   * cusps between close poses, always the same one. Only for goals straight ahead or aside may the
   * one from b to a be another. */
  ReedsSheppCurve connect(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) const;
  /** A shortest one of the curves that only go forward (Dubins, "On curves of minimal length with
   * a constraint on average curvature", 1957). */
  ReedsSheppCurve connectForward(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) const;

 private:
  mrpt::math::TPose2D scaled(const mrpt::math::TPose2D& pose) const;
  /** \param word of a car whose turning radius is 1 */
  ReedsSheppCurve curveOf(const mrpt::math::TPose2D& from,
                          std::array<ReedsSheppCurve::Segment, 5> word) const;

  double m_radius;
};

}  // namespace semantic_planning
