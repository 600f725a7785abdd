#include <semantic_driving/Recovery.h>

#include <cmath>
#include <limits>

namespace semantic_driving {

using colored_graph::ClassOrder;
using mrpt::math::TPose2D;
using semantic_planning::EdgeChecker;
using semantic_planning::Ground;
using semantic_planning::GroundOptions;
using semantic_planning::GroundPose;
using semantic_planning::PathPoint;
using semantic_planning::PlanStatus;
using semantic_planning::SemanticPlanner;
using semantic_planning::VehicleOptions;

namespace {

/** What was forbidden is one rank behind the others. */
ClassOrder allowingAll(const ClassOrder& order) {
  std::vector<std::vector<colored_graph::GraphClass>> ranks(order.ranks() + 1);
  for (int id = 0; id < order.classes(); ++id) {
    const auto classId = static_cast<colored_graph::GraphClass>(id);
    const colored_graph::Rank rank = order.rank(classId);
    ranks[rank == colored_graph::kForbidden ? order.ranks() : rank].push_back(classId);
  }
  if (ranks.back().empty()) ranks.pop_back();
  if (ranks.size() > colored_graph::kMaxRanks) {  // the two worst share one
    ranks[ranks.size() - 2].insert(ranks[ranks.size() - 2].end(), ranks.back().begin(),
                                   ranks.back().end());
    ranks.pop_back();
  }
  return ClassOrder(order.classes(), ranks);
}

VehicleOptions withoutClearance(VehicleOptions vehicle) {
  vehicle.clearance = 0;
  return vehicle;
}

GroundOptions withoutKeepingOff(GroundOptions ground) {
  ground.keepOff = false;
  return ground;
}

class RecoverySearch {
 public:
  RecoverySearch(const SemanticPlanner& planner, double z, const RecoveryOptions& options)
      : m_planner(planner),
        m_options(options),
        m_z(z),
        m_vehicle(withoutClearance(planner.options().vehicle)),
        m_order(allowingAll(planner.order())),
        m_ground(planner.ground().map(), m_vehicle, withoutKeepingOff(planner.options().ground),
                 m_order),
        m_checker(m_ground, m_vehicle, m_order, planner.options().reading) {}

  DrivePath search(const TPose2D& from, double nearest) {
    const auto start = m_checker.place(from, m_z);
    if (!start) return {};
    const double step = m_options.step;
    for (double r = nearest + step; isWorthwhile(r, nearest); r += step)
      for (int direction = 0; direction < m_options.directions; ++direction)
        for (int heading = 0; heading < m_options.headings; ++heading) {
          const double to = from.phi + direction * 2 * M_PI / m_options.directions;
          consider(*start, {from.x + r * std::cos(to), from.y + r * std::sin(to),
                            from.phi + heading * 2 * M_PI / m_options.headings});
        }
    return DrivePath(m_best);
  }

 private:
  bool isWorthwhile(double r, double nearest) const {
    return r <= m_options.radius && r < m_leastForbidden + nearest + m_options.further;
  }

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
    const double same = m_options.same;
    const bool less = forbidden < m_leastForbidden - same;
    if (!less && (forbidden > m_leastForbidden + same || length >= m_leastLength)) return;
    m_leastForbidden = forbidden, m_leastLength = length;
    m_best = points;
  }

  const SemanticPlanner& m_planner;
  const RecoveryOptions& m_options;
  double m_z;
  VehicleOptions m_vehicle;
  ClassOrder m_order;
  Ground m_ground;
  EdgeChecker m_checker;
  std::vector<PathPoint> m_best;
  double m_leastForbidden = std::numeric_limits<double>::infinity(), m_leastLength = 0;
};

}  // namespace

void RecoveryOptions::describe(strict_files::OptionList& list) {
  using strict_files::above;
  using strict_files::atLeast;
  list.add("radius", radius, "m", above(0), "how far ways out are looked for");
  list.add("blind", blind, "m", atLeast(0),
           "how near the sensors may not see the ground, at the beginning");
  list.add("step", step, "m", above(0), "between distances of places that are tried");
  list.add("directions", directions, "", atLeast(1), "wherein they lie");
  list.add("headings", headings, "", atLeast(1), "of each place");
  list.add("same", same, "m", atLeast(0), "of forbidden ground, that makes no difference");
  list.add("further", further, "m", atLeast(0),
           "beyond the least way over forbidden ground, where a shorter way is looked for");
}

void RecoveryOptions::validate() const { strict_files::checkOptions(*this, "RecoveryOptions"); }

DrivePath findRecovery(const SemanticPlanner& planner, const TPose2D& from, double z,
                       const RecoveryOptions& options, double nearest) {
  options.validate();
  return RecoverySearch(planner, z, options).search(from, nearest);
}

}  // namespace semantic_driving
