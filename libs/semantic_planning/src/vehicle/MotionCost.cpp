#include <semantic_planning/vehicle/MotionCost.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace semantic_planning {

using mrpt::math::TPose2D;

namespace {

/** Segments that are shorter are what rounding leaves, meters. */
constexpr double kStandstill = 1e-6;

bool isSomething(const ReedsSheppCurve::Segment& segment) {
  return std::abs(segment.length) > kStandstill;
}

CurveState stateOf(const ReedsSheppCurve::Segment& segment, double turningRadius) {
  return {segment.length > 0, segment.turn / turningRadius};
}

template <class Iterator>
CurveState firstOf(Iterator begin, Iterator end, double turningRadius) {
  const Iterator first = std::find_if(begin, end, isSomething);
  return first == end ? CurveState() : stateOf(*first, turningRadius);
}

}  // namespace

CurveState beginOf(const ReedsSheppCurve& curve) {
  return firstOf(curve.segments().begin(), curve.segments().end(), curve.turningRadius());
}

CurveState endOf(const ReedsSheppCurve& curve) {
  return firstOf(curve.segments().rbegin(), curve.segments().rend(), curve.turningRadius());
}

MotionCost::MotionCost(const VehicleOptions& vehicle)
    : m_reedsShepp(vehicle.turningRadius),
      m_reverse(vehicle.reverseWeight),
      m_gearChange(vehicle.gearChange),
      m_steering(vehicle.steeringChange) {}

double MotionCost::of(const ReedsSheppCurve& curve) const {
  double price = 0;
  std::optional<CurveState> before;
  for (const ReedsSheppCurve::Segment& segment : curve.segments()) {
    if (!isSomething(segment)) continue;
    const CurveState state = stateOf(segment, curve.turningRadius());
    price += ofWay(std::abs(segment.length), state.forward);
    if (before) price += ofChange(*before, state);
    before = state;
  }
  return price;
}

double MotionCost::of(const std::vector<PathPoint>& path) const {
  double price = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    price += ofWay(path[i].arcLength - path[i - 1].arcLength, path[i].forward);
    if (i > 1) price += ofChange(stateAt(path[i - 1]), stateAt(path[i]));
  }
  return price;
}

ReedsSheppCurve MotionCost::shortest(const TPose2D& a, const TPose2D& b) const {
  return canReverse() ? m_reedsShepp.connect(a, b) : m_reedsShepp.connectForward(a, b);
}

std::vector<ReedsSheppCurve> MotionCost::curves(const TPose2D& a, const TPose2D& b) const {
  std::vector<ReedsSheppCurve> curves;
  curves.reserve(3);
  curves.push_back(shortest(a, b));
  const auto isBackward = [](const auto& segment) { return segment.length < -kStandstill; };
  const auto& segments = curves.front().segments();
  if (std::none_of(segments.begin(), segments.end(), isBackward)) return curves;
  curves.push_back(m_reedsShepp.connectForward(a, b));
  curves.push_back(m_reedsShepp.connectForward(b, a).reversed());
  return curves;
}

}  // namespace semantic_planning
