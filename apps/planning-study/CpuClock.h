#pragma once
#include <ctime>

namespace planning_study {

/** Milliseconds of processor time that this process has used. What else runs on the machine does
 * not count, so that times of a busy machine can be compared. */
inline double cpuMilliseconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace planning_study
