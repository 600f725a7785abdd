#pragma once
#include <colored_graph/PathResult.h>
#include <colored_graph/SearchOptions.h>

#include <chrono>
#include <limits>
#include <optional>

namespace colored_graph {

/** Whether a search that began when this was made should stop. */
class StopCheck {
 public:
  explicit StopCheck(const SearchOptions& options) : m_options(options) {}

  /** Before something that may take long. */
  std::optional<SearchStatus> now() const {
    if (m_options.cancelled && m_options.cancelled()) return SearchStatus::Cancelled;
    if (m_options.timeLimit == std::numeric_limits<double>::infinity()) return std::nullopt;
    const std::chrono::duration<double> passed = Clock::now() - m_begin;
    if (passed.count() >= m_options.timeLimit) return SearchStatus::TimeLimit;
    return std::nullopt;
  }

  /** In a loop whose turns are short: looks in the first turn and then in every 32nd. */
  std::optional<SearchStatus> inLoop() { return m_turns++ % 32 == 0 ? now() : std::nullopt; }

 private:
  using Clock = std::chrono::steady_clock;

  const SearchOptions& m_options;
  Clock::time_point m_begin = Clock::now();
  unsigned m_turns = 0;
};

}  // namespace colored_graph
