#pragma once
#include <time.h>

namespace semantic_map_drive {

/** Time of the processor, so that what else runs on the machine does not count. */
class Stopwatch {
 public:
  /** Since it was made, or asked last. */
  double milliseconds() {
    const double before = m_begin;
    m_begin = now();
    return m_begin - before;
  }

 private:
  static double now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
  }

  double m_begin = now();
};

}  // namespace semantic_map_drive
