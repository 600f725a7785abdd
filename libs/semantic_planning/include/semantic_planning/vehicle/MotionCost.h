#pragma once
#include <semantic_planning/vehicle/PathPoint.h>
#include <semantic_planning/vehicle/ReedsShepp.h>
#include <semantic_planning/vehicle/VehicleOptions.h>

#include <cmath>
#include <vector>

namespace semantic_planning {

/** How a curve is entered or left. */
struct CurveState {
  bool forward = true;
  double curvature = 0;  ///< 1/m, of the steering: positive to the left, whatever the gear
};

/** What driving costs a vehicle beside the classes that it drives over, in meters forward: meters,
 * those backwards weighted, and changes of gear and steering. */
class MotionCost {
 public:
  explicit MotionCost(const VehicleOptions& vehicle);

  bool canReverse() const { return std::isfinite(m_reverse); }
  double gearChange() const { return m_gearChange; }
  /** What a way without changes costs. */
  double ofWay(double meters, bool forward) const { return forward ? meters : m_reverse * meters; }
  double ofChange(const CurveState& from, const CurveState& to) const {
    return (from.forward != to.forward ? m_gearChange : 0) +
           (steers(from.curvature, to.curvature) ? m_steering : 0);
  }
  /** Whether these curvatures are more than rounding apart. */
  static bool steers(double from, double to) { return std::abs(to - from) > 1e-6; }
  /** What a curve by itself costs; infinite if the vehicle cannot drive it. */
  double of(const ReedsSheppCurve& curve) const;
  /** What a path costs, from point to point. */
  double of(const std::vector<PathPoint>& path) const;

  /** The shortest curve from a to b that the vehicle can drive. */
  ReedsSheppCurve shortest(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) const;
  /** The curves from a to b of which one is mostly the cheapest: the shortest of all, and the
   * shortest without a change of gear. */
  std::vector<ReedsSheppCurve> curves(const mrpt::math::TPose2D& a,
                                      const mrpt::math::TPose2D& b) const;

 private:
  ReedsShepp m_reedsShepp;
  double m_reverse, m_gearChange, m_steering;
};

/** On the way to a point. */
inline CurveState stateAt(const PathPoint& p) { return {p.forward, p.curvature}; }
/** How a curve begins and ends; of one without length, going ahead. */
CurveState beginOf(const ReedsSheppCurve& curve);
CurveState endOf(const ReedsSheppCurve& curve);

}  // namespace semantic_planning
