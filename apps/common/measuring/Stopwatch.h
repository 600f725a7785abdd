#pragma once

namespace measuring {

/** What a stopwatch counts: time on the wall, or of the processor, so that what else runs on the
 * machine does not count: of this process, or of the thread that asks. */
enum class TimeOf { Wall, Process, Thread };

/** Measures times that follow each other. */
class Stopwatch {
 public:
  /** Begins. */
  explicit Stopwatch(TimeOf what = TimeOf::Wall) : m_what(what), m_begin(now(what)) {}

  /** Milliseconds since it began, or since the last lap. */
  double milliseconds() const { return now(m_what) - m_begin; }
  /** The same, and begins anew. */
  double lap();

 private:
  static double now(TimeOf what);

  TimeOf m_what;
  double m_begin;
};

}  // namespace measuring
