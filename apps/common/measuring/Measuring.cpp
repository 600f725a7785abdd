#include "Measuring.h"

#include <time.h>

#include <algorithm>
#include <stdexcept>
#include <string>

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

double quantile(std::vector<double> values, double share) {
  if (values.empty()) throw std::invalid_argument("a quantile of no values");
  if (!(share >= 0 && share <= 1))
    throw std::invalid_argument("a quantile's share is " + std::to_string(share) +
                                ", expected 0 to 1");
  const double rank = share * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), below, values.end());
  if (below + 1 == values.end()) return *below;
  const double above = *std::min_element(below + 1, values.end());
  return *below + (rank - static_cast<double>(below - values.begin())) * (above - *below);
}

}  // namespace measuring
