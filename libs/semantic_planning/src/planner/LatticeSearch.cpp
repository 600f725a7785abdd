#include "LatticeSearch.h"

#include <semantic_planning/planner/Slices.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <queue>

namespace semantic_planning {

using colored_graph::Length;
using colored_graph::lengthDown;

namespace {

class LatticeSearch {
 public:
  LatticeSearch(const std::vector<Station>& stations, const CollisionChecker& checker,
                const ClassPrices& prices, std::size_t span)
      : m_checker(checker),
        m_cost(checker.motionCost()),
        m_prices(prices),
        m_span(span),
        m_budget{prices.perMeter()} {
    for (const Station& station : stations) {
      m_places.emplace_back();
      const bool isEnd = m_places.size() == 1 || m_places.size() == stations.size();
      for (const GroundPose& pose : station) {
        const mrpt::math::TPoint2D heading(std::cos(pose.pose.phi), std::sin(pose.pose.phi));
        m_places.back().push_back({pose, heading, isEnd || m_places.back().empty()});
      }
    }
  }

  std::vector<Leg> run() {
    for (Place& start : m_places.front()) start.cost = 0;
    for (std::size_t i = 1; i < m_places.size(); ++i)
      for (Place& to : m_places[i]) arriveAt(to, i);
    std::vector<Leg> legs;
    const Place* place = m_places.back().empty() ? nullptr : &m_places.back().back();
    for (; place && place->before; place = place->before) legs.push_back(*place->last);
    std::reverse(legs.begin(), legs.end());
    return legs;
  }

 private:
  static constexpr double kFarthest = 15;  ///< of poses from each other, meters
  static constexpr Length kUnreached = std::numeric_limits<Length>::max();

  struct Place {
    GroundPose pose;
    mrpt::math::TPoint2D heading;  ///< unit vector
    bool isFree;                   ///< to connect with poses that head elsewhere
    Length cost = kUnreached;      ///< of the best way that is known to it
    const Place* before = nullptr;
    const Leg* last = nullptr;
  };

  /** A way that arrives at the present place, and the least that it costs. */
  struct Way {
    Length bound;
    const Place* from;
    const ReedsSheppCurve* curve;                                   ///< null: any
    bool operator<(const Way& o) const { return o.bound < bound; }  // the least on top
  };

  /** The most promising ways first. */
  void arriveAt(Place& to, std::size_t station) {
    m_ways = {};
    m_curves.clear();
    for (std::size_t i = station - std::min(station, m_span); i < station; ++i)
      for (const Place& from : m_places[i]) addOrigin(from, to);
    while (!m_ways.empty() && m_ways.top().bound < to.cost) {
      const Way way = m_ways.top();
      m_ways.pop();
      if (way.curve)
        drive(way, to);
      else
        addCurves(*way.from, to);
    }
  }

  void addOrigin(const Place& from, const Place& to) {
    constexpr double kLeastAhead = 0.3;  // of the distance
    const double dx = to.pose.pose.x - from.pose.pose.x, dy = to.pose.pose.y - from.pose.pose.y;
    const double distance = std::hypot(dx, dy);
    if (from.cost == kUnreached || distance > kFarthest) return;
    const double fromAhead = from.heading.x * dx + from.heading.y * dy;
    const double toAhead = to.heading.x * dx + to.heading.y * dy;
    if (from.isFree || to.isFree ||
        (fromAhead * toAhead > 0 &&
         std::min(std::abs(fromAhead), std::abs(toAhead)) >= kLeastAhead * distance))
      m_ways.push({from.cost + lengthDown(distance), &from, nullptr});
  }

  void addCurves(const Place& from, const Place& to) {
    Slices::count(10);
    for (const ReedsSheppCurve& curve : m_cost.curves(from.pose.pose, to.pose.pose)) {
      Length cost = from.cost + lengthDown(m_cost.of(curve));
      if (from.last) cost += lengthDown(m_cost.ofChange(endOf(from.last->curve), beginOf(curve)));
      if (cost < to.cost) m_ways.push({cost, &from, &m_curves.emplace_back(curve)});
    }
  }

  void drive(const Way& way, Place& to) {
    constexpr double kSlack = 1e-3;  // m: lengths are rounded
    Slices::count(25);
    m_budget.left = colored_graph::toMeters(to.cost - way.bound) + kSlack;
    const auto profile = m_checker.profile(*way.curve, way.from->pose.z, to.pose.z, &m_budget);
    if (!profile) return;
    const Length cost = way.bound + m_prices.of(*profile);
    if (cost >= to.cost) return;
    to.cost = cost;
    to.before = way.from;
    to.last = &m_legs.emplace_back(Leg{*way.curve, way.from->pose.z});
  }

  const CollisionChecker& m_checker;
  const MotionCost& m_cost;
  const ClassPrices& m_prices;
  const std::size_t m_span;
  std::vector<std::vector<Place>> m_places;
  std::deque<Leg> m_legs;
  std::priority_queue<Way> m_ways;  ///< to the present place
  std::deque<ReedsSheppCurve> m_curves;
  ClassBudget m_budget;
};

}  // namespace

std::vector<Leg> cheapestLegs(const std::vector<Station>& stations, std::size_t span,
                              const CollisionChecker& checker, const ClassPrices& prices) {
  return LatticeSearch(stations, checker, prices, span).run();
}

}  // namespace semantic_planning
