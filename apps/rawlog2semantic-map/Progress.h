#pragma once
#include <cstdint>
#include <string>

#include "measuring/Stopwatch.h"

namespace rawlog2semantic_map {

/** Says on the standard output how far a task is: a bar on a terminal, a line now and then
 * elsewhere. */
class Progress {
 public:
  /** \param task what is done, "Reading poses" \param total of what update() gets */
  Progress(std::string task, std::uint64_t total);

  /** \param note short, "12 scans" */
  void update(std::uint64_t done, const std::string& note);
  /** Says that the task is complete. */
  void finish(const std::string& note);

 private:
  void drawBar(double share, const std::string& note);

  std::string m_task;
  std::uint64_t m_total;
  bool m_onTerminal;
  measuring::Stopwatch m_sinceSaid;
};

}  // namespace rawlog2semantic_map
