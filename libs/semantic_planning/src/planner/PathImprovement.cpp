#include "PathImprovement.h"

#include <algorithm>
#include <cmath>

#include "PathStations.h"
#include "PathTracing.h"

namespace semantic_planning {

using colored_graph::Length;

namespace {

using Lengths = std::vector<Length>;

/** Lengths by rank, worst first, without the best. */
Lengths ranksOf(const PlanResult& plan, const colored_graph::ClassOrder& order) {
  Lengths ranks(static_cast<std::size_t>(order.ranks()) - 1);
  for (std::size_t id = 0; id < plan.lengthPerClass.size(); ++id) {
    const auto rank = static_cast<std::size_t>(order.rank(static_cast<ClassId>(id)));
    if (plan.lengthPerClass[id] > 0 && rank > 0)
      ranks[ranks.size() - rank] +=
          std::llround(plan.lengthPerClass[id] * colored_graph::kLengthUnitsPerMeter);
  }
  return ranks;
}

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
  after.cost = ranksOf(after, checker.order());
  after.cost.push_back(colored_graph::lengthDown(checker.price().of(after.path)));
  after.cost.push_back(std::llround(after.length * colored_graph::kLengthUnitsPerMeter));
  return after;
}

class Improvement {
 public:
  Improvement(PlanResult& result, const EdgeChecker& checker, double tolerance)
      : m_result(result),
        m_checker(checker),
        m_tolerance(colored_graph::lengthDown(tolerance)),
        m_weights(static_cast<std::size_t>(checker.order().ranks()), kFirstWeight) {
    if (result.found()) m_least = ranks(result);
    m_weights.front() = 0;
  }

  /** \return whether the result became better. */
  bool through(StationSearch search) {
    const auto inOrder = search.run(WayPricing::inOrder(m_checker.order()));
    if (!inOrder || inOrder->empty()) return false;
    PlanResult best = withLegs(m_result, *inOrder, m_checker);
    if (!m_least || worseRank(*m_least, ranks(best))) m_least = ranks(best);
    const bool isBetter = offer(best);
    for (int round = 0; round < kMostRounds; ++round) {
      PlanResult cheap = withLegs(m_result, *search.run({m_checker.order(), m_weights}), m_checker);
      const auto over = worseRank(ranks(cheap), *m_least);
      if (!over) return offer(cheap) || isBetter;
      m_weights[m_weights.size() - 1 - *over] *= kMoreWeight;
    }
    return isBetter;
  }

 private:
  static constexpr Length kFirstWeight = 10, kMoreWeight = 6;
  static constexpr int kMostRounds = 4;

  Lengths ranks(const PlanResult& plan) const { return ranksOf(plan, m_checker.order()); }

  /** The worst rank in which lengths differ by more than the tolerance, if they are worse there. */
  std::optional<std::size_t> worseRank(const Lengths& lengths, const Lengths& than) const {
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      if (lengths[i] > than[i] + m_tolerance) return i;
      if (lengths[i] < than[i] - m_tolerance) return std::nullopt;
    }
    return std::nullopt;
  }

  bool offer(PlanResult& offered) {
    if (worseRank(ranks(offered), *m_least)) return false;
    const DrivePrice& price = m_checker.price();
    const bool isBetter = !m_result.found() || worseRank(ranks(m_result), *m_least) ||
                          price.of(offered.path) < price.of(m_result.path);
    if (isBetter) m_result = std::move(offered);
    return isBetter;
  }

  PlanResult& m_result;
  const EdgeChecker& m_checker;
  const Length m_tolerance;
  std::optional<Lengths> m_least;  ///< of the best path that is known
  std::vector<Length> m_weights;
};

}  // namespace

void improvePath(PlanResult& result, const std::vector<PathPoint>& guide,
                 const EdgeChecker& checker, const ImprovementOptions& options) {
  constexpr std::size_t kSpanBeside = 2, kSpanOn = 8;  // stations that a curve goes on by at most
  Improvement improvement(result, checker, options.classTolerance);
  const auto beside = [&](const std::vector<PathPoint>& path, const BesideOptions& poses) {
    return improvement.through(
        {stationsBeside(path, checker, poses), checker, kSpanBeside, options.reach});
  };
  const auto on = [&] {
    return improvement.through({stationsOn(result.path, checker), checker, kSpanOn, options.reach});
  };
  constexpr double kTurn = 20 * M_PI / 180;
  if (guide.empty() && !result.found()) return;
  beside(guide.empty() ? result.path : guide, {0.6, kTurn, false});
  if (!result.found()) return;
  on();
  if (beside(result.path, {0.3, kTurn / 2, true})) on();
}

}  // namespace semantic_planning
