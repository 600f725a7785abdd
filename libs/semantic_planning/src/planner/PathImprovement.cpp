#include "PathImprovement.h"

#include <algorithm>
#include <cmath>

#include "PathSmoothing.h"
#include "PathStations.h"
#include "PathTracing.h"
#include "PoseSearch.h"

namespace semantic_planning {

namespace {

/** By rank, worst first, without the best; then motion cost and length. */
std::vector<std::int64_t> costOf(const PlanResult& plan, const CollisionChecker& checker) {
  const colored_graph::ClassOrder& order = checker.order();
  const auto units = [](double meters) {
    return std::llround(meters * colored_graph::kLengthUnitsPerMeter);
  };
  std::vector<std::int64_t> cost(static_cast<std::size_t>(order.ranks()) - 1);
  for (std::size_t id = 0; id < plan.lengthPerClass.size(); ++id) {
    const auto rank = static_cast<std::size_t>(order.rank(static_cast<ClassId>(id)));
    if (plan.lengthPerClass[id] > 0 && rank > 0)
      cost[cost.size() - rank] += units(plan.lengthPerClass[id]);
  }
  cost.push_back(colored_graph::lengthDown(checker.motionCost().of(plan.path)));
  cost.push_back(units(plan.length));
  return cost;
}

bool changesGear(const std::vector<PathPoint>& path) {
  return std::adjacent_find(path.begin() + 1, path.end(),
                            [](const PathPoint& a, const PathPoint& b) {
                              return a.forward != b.forward;
                            }) != path.end();
}

/** Makes one path cheaper, step by step. */
class Improvement {
 public:
  Improvement(const CollisionChecker& checker, const ClassPrices& prices)
      : m_checker(checker), m_prices(prices) {}

  PlanResult run(const std::vector<PathPoint>& way, bool isDrivable) {
    if (isDrivable) offer(legsAlong(way, m_checker, m_prices));
    improve(way);
    return m_result;
  }

 private:
  static constexpr double kTurn = 20 * M_PI / 180;
  static constexpr std::size_t kSpanBeside = 2, kSpanOn = 8;  // stations that a curve goes on by

  void improve(const std::vector<PathPoint>& way) {
    offer(search(stationsBeside(way, m_checker, {0.6, kTurn, false}), kSpanBeside));
    if (!m_result.found()) return;
    changeGearLess();
    smooth();
    if (!turnBetter()) return;
    changeGearLess();
    smooth();
  }

  std::vector<Leg> search(const std::vector<Station>& stations, std::size_t span) const {
    return LatticeSearch(stations, m_checker, m_prices, span).run().value_or(std::vector<Leg>());
  }

  void changeGearLess() {
    if (!changesGear(m_result.path)) return;
    offer(search(stationsOn(m_result.path, m_checker), kSpanOn));
    if (offer(
            search(stationsBeside(m_result.path, m_checker, {0.3, kTurn / 2, true}), kSpanBeside)))
      offer(search(stationsOn(m_result.path, m_checker), kSpanOn));
  }

  /** Where the path begins and ends: there the vehicle may have to turn around, by a way that is
   * far from all poses beside it. */
  bool turnBetter() {
    bool isBetter = false;
    for (const auto better : {withBetterBegin, withBetterEnd})
      if (const auto path = better(m_result.path, m_checker, m_prices))
        isBetter |= offer(legsAlong(*path, m_checker, m_prices));
    return isBetter;
  }

  void smooth() { offer(smoothed(m_result.path, m_checker, m_prices)); }

  /** \return whether that costs less than what there is. */
  bool offer(const std::vector<Leg>& legs) {
    if (legs.empty()) return false;
    PlanResult offered = withLegs(legs);
    if (m_result.found() && m_result.price <= offered.price) return false;
    m_result = std::move(offered);
    return true;
  }

  PlanResult withLegs(const std::vector<Leg>& legs) const {
    PlanResult after;
    after.status = PlanStatus::Found;
    after.vertices = {legs.front().curve.from()};
    colored_graph::PathResult lengths;
    lengths.lengthPerClass.resize(static_cast<std::size_t>(m_checker.order().classes()));
    for (const Leg& leg : legs) {
      appendCurve(m_checker.trace(leg.curve, leg.from), after.path);
      after.vertices.push_back(leg.curve.at(leg.curve.length()).pose);
      for (const auto& stretch : leg.profile)
        lengths.lengthPerClass[stretch.classId] += stretch.length;
    }
    setLengths(lengths, after);
    after.cost = costOf(after, m_checker);
    after.price = priceOf(after, m_checker, m_prices);
    return after;
  }

  const CollisionChecker& m_checker;
  const ClassPrices& m_prices;
  PlanResult m_result;
};

}  // namespace

double priceOf(const PlanResult& plan, const CollisionChecker& checker, const ClassPrices& prices) {
  double price = checker.motionCost().of(plan.path);
  for (std::size_t id = 0; id < plan.lengthPerClass.size(); ++id)
    if (plan.lengthPerClass[id] > 0)
      price +=
          prices.rate(checker.order().rank(static_cast<ClassId>(id))) * plan.lengthPerClass[id];
  return price;
}

void setLengths(PlanResult& plan, const CollisionChecker& checker, const ClassPrices& prices) {
  std::vector<PathPoint>& path = plan.path;
  plan.lengthPerClass.assign(static_cast<std::size_t>(checker.order().classes()), 0);
  plan.vertices = {{path.front().x, path.front().y, path.front().heading}};
  path.front().arcLength = 0;
  ClassId id = path.front().classId;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const PathPoint& before = path[i - 1];
    PathPoint& p = path[i];
    const double length = std::hypot(p.x - before.x, p.y - before.y);
    p.arcLength = before.arcLength + length;
    if (checker.order().rank(p.classId) != colored_graph::kForbidden) id = p.classId;
    plan.lengthPerClass[id] += length;
    const bool goesOn = i + 1 < path.size() && path[i + 1].forward == p.forward &&
                        !MotionCost::steers(p.curvature, path[i + 1].curvature);
    if (!goesOn) plan.vertices.emplace_back(p.x, p.y, p.heading);
  }
  plan.length = path.back().arcLength;
  plan.cost = costOf(plan, checker);
  plan.price = priceOf(plan, checker, prices);
}

PlanResult pathBeside(const std::vector<PathPoint>& way, bool isDrivable,
                      const CollisionChecker& checker, const ClassPrices& prices) {
  if (way.size() > 2) return Improvement(checker, prices).run(way, isDrivable);
  PlanResult result;
  if (!isDrivable || way.empty()) return result;
  result.status = PlanStatus::Found;
  result.path = way;
  setLengths(result, checker, prices);
  return result;
}

}  // namespace semantic_planning
