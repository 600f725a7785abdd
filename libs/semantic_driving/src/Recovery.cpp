#include "Recovery.h"

#include <cmath>
#include <limits>

namespace semantic_driving {

using colored_graph::ClassOrder;
using mrpt::math::TPose2D;
using namespace semantic_planning;

namespace {

constexpr double kRecoveryRadius = 8;    // m: how far ways out are looked for
constexpr double kRecoveryStep = 0.4;    // m between distances of places that are tried
constexpr int kRecoveryDirections = 16;  // in which they lie
constexpr int kRecoveryHeadings = 8;     // of each place
constexpr double kSameForbidden = 0.1;   // m of forbidden ground that make no difference
// m beyond the least way over forbidden ground where a shorter way is looked for
constexpr double kRecoveryFurther = 2;

/** What was forbidden is one rank behind all others. */
ClassOrder allowingAll(const ClassOrder& order) {
  std::vector<std::vector<colored_graph::GraphClass>> ranks(2);
  for (int id = 0; id < order.classes(); ++id) {
    const auto classId = static_cast<colored_graph::GraphClass>(id);
    ranks[order.rank(classId) == colored_graph::kForbidden ? 1 : 0].push_back(classId);
  }
  if (ranks.back().empty()) ranks.pop_back();
  return ClassOrder(order.classes(), ranks);
}

/** Without clearance, and with forbidden classes below the footprint. */
PlannerOptions leniently(PlannerOptions options) {
  options.vehicle.clearance = 0;
  options.ground.keepOff = false;
  return options;
}

class RecoverySearch {
 public:
  RecoverySearch(const SemanticPlanner& planner, double z)
      : m_planner(planner),
        m_z(z),
        m_options(leniently(planner.options())),
        m_order(allowingAll(planner.order())),
        m_ground(planner.ground().map(), m_options.vehicle, m_options.ground, m_order),
        m_checker(m_ground, m_options.vehicle, m_order) {}

  DrivePath search(const TPose2D& from, double nearest) {
    const auto start = m_checker.place(from, m_z);
    if (!start) return {};
    for (double r = nearest + kRecoveryStep;
         r <= kRecoveryRadius && r < m_leastForbidden + nearest + kRecoveryFurther;
         r += kRecoveryStep)
      for (int direction = 0; direction < kRecoveryDirections; ++direction)
        for (int heading = 0; heading < kRecoveryHeadings; ++heading) {
          const double to = from.phi + direction * 2 * M_PI / kRecoveryDirections;
          consider(*start, {from.x + r * std::cos(to), from.y + r * std::sin(to),
                            from.phi + heading * 2 * M_PI / kRecoveryHeadings});
        }
    return DrivePath(m_best);
  }

 private:
  void consider(const GroundPose& start, const TPose2D& pose) {
    if (m_planner.check(pose, m_z) != PlanStatus::Found) return;
    const auto end = m_checker.place(pose, m_z);
    if (!end || !m_checker.profile(start, *end)) return;
    const auto points =
        m_checker.trace(m_checker.reedsShepp().connect(start.pose, end->pose), start.z);
    double forbidden = 0, length = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const double piece = std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
      length += piece;
      if (m_planner.order().rank(points[i].classId) == colored_graph::kForbidden)
        forbidden += piece;
    }
    const bool less = forbidden < m_leastForbidden - kSameForbidden;
    if (!less && (forbidden > m_leastForbidden + kSameForbidden || length >= m_leastLength)) return;
    m_leastForbidden = forbidden, m_leastLength = length;
    m_best = points;
  }

  const SemanticPlanner& m_planner;
  double m_z;
  PlannerOptions m_options;
  ClassOrder m_order;
  Ground m_ground;
  CollisionChecker m_checker;
  std::vector<PathPoint> m_best;
  double m_leastForbidden = std::numeric_limits<double>::infinity(), m_leastLength = 0;
};

}  // namespace

DrivePath findRecovery(const SemanticPlanner& planner, const TPose2D& from, double z,
                       double nearest) {
  return RecoverySearch(planner, z).search(from, nearest);
}

}  // namespace semantic_driving
