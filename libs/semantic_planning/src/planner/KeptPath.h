#pragma once
#include <semantic_planning/planner/PlanResult.h>
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "ClassPrices.h"

namespace semantic_planning {

/** Measures stages that follow each other. */
class StageClock {
 public:
  /** Ends a stage: it took the time since the last one ended. */
  void end(const std::string& stage) { m_times.emplace_back(stage, lap()); }
  /** The last stage, of which a part is to count as a stage of its own. */
  void end(const std::string& stage, const std::string& part, double partMilliseconds) {
    m_times.emplace_back(stage, lap() - partMilliseconds);
    m_times.emplace_back(part, partMilliseconds);
  }
  StageTimes take() { return std::move(m_times); }

  static double millisecondsSince(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
  }

 private:
  double lap() {
    const double passed = millisecondsSince(m_begin);
    m_begin = std::chrono::steady_clock::now();
    return passed;
  }

  std::chrono::steady_clock::time_point m_begin = std::chrono::steady_clock::now();
  StageTimes m_times;
};

/** The path that was planned last, kept true to the ground. A vehicle on it needs no search as long
 * as nothing is in the way and no other way costs clearly less. */
class KeptPath {
 public:
  /** Checker and prices must outlive the path. */
  KeptPath(const CollisionChecker& checker, const ClassPrices& prices)
      : m_checker(checker), m_prices(prices) {}

  /** \param least what the way of a vehicle costs that turns on the spot, meters */
  void keep(const PlanResult& plan, double least);
  void drop() { m_plan = {}; }
  bool isKept() const { return m_plan.found(); }
  /** Looks again at the path, if any did. */
  void groundChanged(const std::vector<Column>& tiles);

  /** What is left of the path from a pose on it; none: it is not on it, or the path is blocked. */
  std::optional<PlanResult> restFrom(const GroundPose& pose) const;
  /** Whether the ground is what it was when the path was planned. */
  bool isOfThisGround() const { return !m_changed; }
  /** Whether another path may cost 0.5 m less, now that the way of a vehicle that turns on the spot
   * costs `least`. */
  bool mayBeBeaten(const PlanResult& rest, double least) const;

 private:
  bool lookAgain();

  const CollisionChecker& m_checker;
  const ClassPrices& m_prices;
  PlanResult m_plan;
  double m_excess = 0;  ///< of its price over the least, meters
  bool m_changed = false;
};

}  // namespace semantic_planning
