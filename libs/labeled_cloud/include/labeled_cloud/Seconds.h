#pragma once
#include <mrpt/core/Clock.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace labeled_cloud {

/** A time in seconds since 1970, as data sets write it.
 * \throw std::invalid_argument it is not finite, or beyond what MRPT's clock can tell. */
inline mrpt::Clock::time_point timeOfSeconds(double seconds) {
  constexpr double kMost = 2e11;  // years: 6000; the clock has 64 bits of 100 ns
  if (!(std::abs(seconds) <= kMost))
    throw std::invalid_argument(std::to_string(seconds) + " s is no time");
  return mrpt::Clock::fromDouble(seconds);
}

}  // namespace labeled_cloud
