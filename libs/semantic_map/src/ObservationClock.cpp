#include <semantic_map/CSemanticOctoMap.h>

#include <chrono>
#include <cmath>

namespace semantic_map {
namespace {

using mrpt::Clock;

double secondsBetween(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

bool ObservationClock::beginsRecording(Clock::time_point stamp) const {
  return !m_latest || (m_maxGap > 0 && std::fabs(secondsBetween(*m_latest, stamp)) > m_maxGap);
}

double ObservationClock::secondsUntil(Clock::time_point stamp) const {
  if (stamp == Clock::time_point() || beginsRecording(stamp) || stamp <= *m_latest) return 0;
  return secondsBetween(*m_latest, stamp);
}

void ObservationClock::note(Clock::time_point stamp) {
  if (stamp == Clock::time_point()) return;
  if (beginsRecording(stamp) || stamp > *m_latest) m_latest = stamp;
}

}  // namespace semantic_map
