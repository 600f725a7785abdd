#pragma once
#include <semantic_planning/roadmap/EdgeChecker.h>

#include <tuple>

namespace semantic_planning {

/** Two poses that a curve connects, in the order in which it runs: the curve back may be another
 * one, so that one of them has to be agreed upon. The order is the poses' own (by x, y, heading,
 * z), whatever their vertices are called. */
struct PosePair {
  PosePair(const GroundPose& a, const GroundPose& b)
      : first(keyOf(b) < keyOf(a) ? b : a), second(keyOf(b) < keyOf(a) ? a : b) {}

  bool operator==(const PosePair& o) const {
    return keyOf(first) == keyOf(o.first) && keyOf(second) == keyOf(o.second);
  }

  double distance(const ReedsShepp& reedsShepp) const {
    return reedsShepp.distance(first.pose, second.pose);
  }
  /** The curve between them that starts at `from`, one of them. */
  ReedsSheppCurve curveFrom(const GroundPose& from, const ReedsShepp& reedsShepp) const {
    const ReedsSheppCurve curve = reedsShepp.connect(first.pose, second.pose);
    return keyOf(from) == keyOf(first) ? curve : curve.reversed();
  }

  GroundPose first, second;

 private:
  static std::tuple<const double&, const double&, const double&, const int&> keyOf(
      const GroundPose& p) {
    return {p.pose.x, p.pose.y, p.pose.phi, p.z};
  }
};

}  // namespace semantic_planning
