#pragma once
#include <semantic_planning/planner/PlanResult.h>

#include <chrono>
#include <string>

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

}  // namespace semantic_planning
