#pragma once
#include <mrpt/core/Clock.h>

#include <optional>

namespace semantic_map {

/** How much time passes from observation to observation, by their stamps: what a map ages by
 * (semantic_octree::SemanticOcTree::age()). */
class ObservationClock {
 public:
  /** \param maxGap seconds: after a longer silence, or a step back by more, another recording has
   * begun, and the time between is not counted; 0: all of it is */
  explicit ObservationClock(double maxGap = 0) : m_maxGap(maxGap) {}
  void setMaxGap(double seconds) { m_maxGap = seconds; }

  /** Seconds to count since the latest observation; 0 for the first, for one that is not later, for
   * one without a stamp, and in another recording. */
  double secondsUntil(mrpt::Clock::time_point stamp) const;
  /** An observation was inserted. */
  void note(mrpt::Clock::time_point stamp);

 private:
  bool beginsRecording(mrpt::Clock::time_point stamp) const;

  double m_maxGap;
  std::optional<mrpt::Clock::time_point> m_latest;
};

}  // namespace semantic_map
