#pragma once
#include <mrpt/obs/CObservation.h>

#include <string>

namespace labeled_cloud {

/** What messages call an observation: class, sensor, time. */
inline std::string nameOf(const mrpt::obs::CObservation& o) {
  return std::string(o.GetRuntimeClass()->className) + " '" + o.sensorLabel + "' at " +
         std::to_string(mrpt::Clock::toDouble(o.timestamp)) + " s";
}

}  // namespace labeled_cloud
