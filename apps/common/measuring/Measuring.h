#pragma once
#include <vector>

namespace measuring {

/** What a stopwatch counts: time on the wall, or processor time of this process or of the thread
 * that asks. What else runs on the machine does not count in the latter. */
enum class TimeOf { Wall, Process, Thread };

/** Measures times that follow each other. */
class Stopwatch {
 public:
  /** Begins. */
  explicit Stopwatch(TimeOf what = TimeOf::Wall) : m_what(what), m_begin(now(what)) {}

  /** Milliseconds since it began, or since the last lap. */
  double milliseconds() const { return now(m_what) - m_begin; }
  /** Milliseconds since the begin; the stopwatch begins anew. */
  double lap();

 private:
  static double now(TimeOf what);

  TimeOf m_what;
  double m_begin;
};

/** The value that a share of the values lie below. Between two values it is interpolated (type 7 of
 * Hyndman, Fan 1996), as R and NumPy do.
 * \param values in any order \param share in [0, 1]
 * \throw std::invalid_argument no values, or another share */
double quantile(std::vector<double> values, double share);

}  // namespace measuring
