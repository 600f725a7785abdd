#include "PathImprovement.h"

#include <algorithm>
#include <cmath>

#include "PathSmoothing.h"
#include "PathStations.h"
#include "PathTracing.h"
#include "TurnSearch.h"

namespace semantic_planning {

using colored_graph::Length;

namespace {

PlanResult withLegs(const PlanResult& before, const std::vector<Leg>& legs,
                    const EdgeChecker& checker) {
  PlanResult after = before;
  after.status = PlanStatus::Found;
  after.reason.clear();
  after.path.clear();
  after.vertices = {legs.front().curve.from()};
  colored_graph::PathResult lengths;
  lengths.lengthPerClass.resize(static_cast<std::size_t>(checker.order().classes()));
  for (const Leg& leg : legs) {
    appendCurve(checker.trace(leg.curve, leg.from), after.path);
    after.vertices.push_back(leg.curve.at(leg.curve.length()).pose);
    for (const auto& stretch : leg.profile)
      lengths.lengthPerClass[stretch.classId] += stretch.length;
  }
  setLengths(lengths, after);
  after.cost = PathOrder(checker, 0).ranks(after);
  after.cost.push_back(colored_graph::lengthDown(checker.price().of(after.path)));
  after.cost.push_back(std::llround(after.length * colored_graph::kLengthUnitsPerMeter));
  return after;
}

bool changesGear(const std::vector<PathPoint>& path) {
  return std::adjacent_find(path.begin() + 1, path.end(),
                            [](const PathPoint& a, const PathPoint& b) {
                              return a.forward != b.forward;
                            }) != path.end();
}

/** Makes one path better, step by step. */
class Improvement {
 public:
  using Lengths = PathOrder::Lengths;

  Improvement(PlanResult& result, const EdgeChecker& checker, const ImprovementOptions& options)
      : m_result(result),
        m_checker(checker),
        m_options(options),
        m_order(checker, options.classTolerance),
        m_weights(static_cast<std::size_t>(checker.order().ranks()), kFirstWeight) {
    if (result.found()) lower(m_order.ranks(result));
    m_weights.front() = 0;
  }

  const Lengths& least() const { return m_least; }

  void run(const std::vector<PathPoint>& around) {
    constexpr double kTurn = 20 * M_PI / 180;
    constexpr std::size_t kSpanBeside = 2, kSpanOn = 8;  // stations that a curve goes on by at most
    through(stationsBeside(around, m_checker, {0.6, kTurn, false}), kSpanBeside);
    if (!m_result.found()) return;
    if (changesGear(m_result.path)) {
      through(stationsOn(m_result.path, m_checker), kSpanOn);
      if (through(stationsBeside(m_result.path, m_checker, {0.3, kTurn / 2, true}), kSpanBeside))
        through(stationsOn(m_result.path, m_checker), kSpanOn);
    }
    smooth();
    if (!turnBetter()) return;
    if (changesGear(m_result.path)) through(stationsOn(m_result.path, m_checker), kSpanOn);
    smooth();
  }

 private:
  static constexpr Length kFirstWeight = 10, kMoreWeight = 6;
  static constexpr int kMostRounds = 4;

  /** \return whether the result became better. */
  bool through(const std::vector<Station>& stations, std::size_t span) {
    StationSearch search(stations, m_checker, span, m_options.reach);
    const auto inOrder = search.run(WayPricing::inOrder(m_checker.order()));
    if (!inOrder || inOrder->empty()) return false;
    PlanResult best = withLegs(m_result, *inOrder, m_checker);
    lower(m_order.ranks(best));
    const bool isBetter = offer(best);
    for (int round = 0; round < kMostRounds; ++round) {
      PlanResult cheap = withLegs(m_result, *search.run({m_checker.order(), m_weights}), m_checker);
      const auto over = m_order.worseRank(m_order.ranks(cheap), m_least);
      if (!over) return offer(cheap) || isBetter;
      m_weights[m_weights.size() - 1 - *over] *= kMoreWeight;
    }
    return isBetter;
  }

  /** Where the path begins and ends: there the vehicle may have to turn around, by a way that is
   * far from all poses beside it. \return whether it has less of a class. */
  bool turnBetter() {
    bool isBetter = false;
    for (const auto search : {withBetterBegin, withBetterEnd}) {
      const auto path = search(m_result.path, m_checker, m_options.classTolerance);
      if (!path) continue;
      PlanResult offered = withLegs(m_result, legsAlong(*path, m_checker), m_checker);
      if (!m_order.worseRank(m_order.ranks(m_result), m_order.ranks(offered))) continue;
      lower(m_order.ranks(offered));
      m_result = std::move(offered);
      isBetter = true;
    }
    return isBetter;
  }

  void smooth() {
    const Lengths before = m_order.ranks(m_result);
    const auto legs = smoothed(m_result.path, m_checker, [&](const ClassLengths& lengths) {
      const Lengths ranks = m_order.ranks(lengths);
      return !m_order.worseRank(ranks, m_least) && !m_order.worseRank(ranks, before);
    });
    PlanResult offered = withLegs(m_result, legs, m_checker);
    offer(offered);
  }

  void lower(const Lengths& lengths) {
    m_least = m_least.empty() ? lengths : std::min(m_least, lengths);
  }

  bool offer(PlanResult& offered) {
    const bool isBetter = m_order.isBetter(offered, m_result, m_least);
    if (isBetter) m_result = std::move(offered);
    return isBetter;
  }

  PlanResult& m_result;
  const EdgeChecker& m_checker;
  const ImprovementOptions& m_options;
  const PathOrder m_order;
  Lengths m_least;  ///< by rank, that are known; empty: none
  std::vector<Length> m_weights;
};

}  // namespace

PathOrder::PathOrder(const EdgeChecker& checker, double tolerance)
    : m_checker(checker), m_tolerance(colored_graph::lengthDown(tolerance)) {}

PathOrder::Lengths PathOrder::ranks(const Lengths& lengths) const {
  const colored_graph::ClassOrder& order = m_checker.order();
  Lengths ranks(static_cast<std::size_t>(order.ranks()) - 1);
  for (std::size_t id = 0; id < lengths.size(); ++id) {
    const auto rank = static_cast<std::size_t>(order.rank(static_cast<ClassId>(id)));
    if (lengths[id] > 0 && rank > 0) ranks[ranks.size() - rank] += lengths[id];
  }
  return ranks;
}

PathOrder::Lengths PathOrder::ranks(const PlanResult& plan) const {
  Lengths lengths;
  for (const double length : plan.lengthPerClass)
    lengths.push_back(std::llround(length * colored_graph::kLengthUnitsPerMeter));
  return ranks(lengths);
}

std::optional<std::size_t> PathOrder::worseRank(const Lengths& ranks, const Lengths& than) const {
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    if (ranks[i] > than[i] + m_tolerance) return i;
    if (ranks[i] < than[i] - m_tolerance) return std::nullopt;
  }
  return std::nullopt;
}

bool PathOrder::isBetter(const PlanResult& plan, const PlanResult& than,
                         const Lengths& least) const {
  if (!plan.found() || !than.found()) return plan.found();
  const Lengths own = ranks(plan), other = ranks(than);
  if (!least.empty()) {
    const bool isOver = worseRank(own, least).has_value();
    const bool isOtherOver = worseRank(other, least).has_value();
    if (isOver != isOtherOver) return isOtherOver;
  }
  if (worseRank(own, other)) return false;
  if (worseRank(other, own)) return true;
  return m_checker.price().of(plan.path) < m_checker.price().of(than.path);
}

void improvePath(PlanResult& result, PathOrder::Lengths& least, const std::vector<PathPoint>& guide,
                 const EdgeChecker& checker, const ImprovementOptions& options) {
  const PathOrder order(checker, options.classTolerance);
  const auto lower = [&least](const PathOrder::Lengths& by) {
    if (!by.empty()) least = least.empty() ? by : std::min(least, by);
  };
  PlanResult beside = result;
  beside.status = PlanStatus::NotConnected;
  if (result.found()) lower(order.ranks(result));
  if (!guide.empty()) {
    Improvement improvement(beside, checker, options);
    improvement.run(guide);
    lower(improvement.least());
  }
  const bool isWorse = !beside.found() || (result.found() && order.worseRank(order.ranks(beside),
                                                                             order.ranks(result)));
  if (isWorse && result.found()) {
    Improvement improvement(result, checker, options);
    improvement.run(result.path);
    lower(improvement.least());
  }
  if (beside.found() && (!isWorse || order.isBetter(beside, result, least)))
    result = std::move(beside);
}

}  // namespace semantic_planning
