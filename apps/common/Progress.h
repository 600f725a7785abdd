#pragma once
#include <chrono>
#include <cstdint>
#include <string>

/** Says how far a task is: on a terminal a bar with the time that is left, elsewhere a line every
 * five seconds. */
class Progress {
 public:
  /** \param task what is done, "Mapping" \param total of what update() gets; 0: nobody knows */
  Progress(std::string task, std::uint64_t total);
  /** The bar is gone. */
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /** \param note short, "12 scans" */
  void update(std::uint64_t done, const std::string& note);

 private:
  using Clock = std::chrono::steady_clock;

  std::string m_task;
  std::uint64_t m_total;
  bool m_onTerminal, m_isDrawn = false;
  Clock::time_point m_began = Clock::now(), m_said;
};
