#pragma once
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <tuple>

namespace semantic_planning {

/** An order of poses: by x, y, heading, z. */
inline bool isBefore(const GroundPose& a, const GroundPose& b) {
  return std::tie(a.pose.x, a.pose.y, a.pose.phi, a.z) <
         std::tie(b.pose.x, b.pose.y, b.pose.phi, b.z);
}

/** Two poses that a curve connects, in the order in which it runs. The curve back may be another
 * one, so one of them is agreed upon. The order is the poses' own (by x, y, heading, z), not their
 * vertices'. Curves of a vehicle that only drives forward run as they are driven. */
struct PosePair {
  PosePair(const GroundPose& a, const GroundPose& b)
      : first(isBefore(b, a) ? b : a), second(isBefore(b, a) ? a : b) {}
  /** The curve is driven from one to the other only. */
  static PosePair oneWay(const GroundPose& from, const GroundPose& to) {
    PosePair pair(from, to);
    pair.first = from, pair.second = to;
    return pair;
  }

  bool operator<(const PosePair& o) const {
    return std::tuple_cat(keyOf(first), keyOf(second)) <
           std::tuple_cat(keyOf(o.first), keyOf(o.second));
  }

  double distance(const ReedsShepp& reedsShepp) const {
    return reedsShepp.distance(first.pose, second.pose);
  }
  /** The vehicle's curve between them that starts at `from`, one of them. */
  ReedsSheppCurve curveFrom(const GroundPose& from, const MotionCost& price) const {
    const ReedsSheppCurve curve = price.shortest(first.pose, second.pose);
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
