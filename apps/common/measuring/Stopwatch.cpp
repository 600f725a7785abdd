#include "Stopwatch.h"

#include <time.h>

namespace measuring {

double Stopwatch::now(TimeOf what) {
  constexpr clockid_t kClocks[] = {CLOCK_MONOTONIC, CLOCK_PROCESS_CPUTIME_ID,
                                   CLOCK_THREAD_CPUTIME_ID};
  timespec t{};
  clock_gettime(kClocks[static_cast<int>(what)], &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double Stopwatch::lap() {
  const double end = now(m_what), passed = end - m_begin;
  m_begin = end;
  return passed;
}

}  // namespace measuring
