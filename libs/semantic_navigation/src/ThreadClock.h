#pragma once
#include <ctime>

namespace semantic_navigation {

/** Milliseconds of the processor that a thread takes, stage by stage. */
class ThreadClock {
 public:
  /** Since it began, or since the last lap. */
  double lap() {
    const double end = now(), passed = end - m_begin;
    m_begin = end;
    return passed;
  }

 private:
  static double now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
  }

  double m_begin = now();
};

}  // namespace semantic_navigation
