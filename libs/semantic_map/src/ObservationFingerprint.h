#pragma once
#include <mrpt/obs/CObservation.h>

#include <cstdint>

namespace semantic_map {

/** A number that stands for all that a scan is made of, its labels and the sensor's pose included:
 * two observations with the same one have the same points. Reads each byte once, which takes a
 * small part of the time that it takes to make points of them. */
std::uint64_t fingerprintOf(const mrpt::obs::CObservation& observation);

}  // namespace semantic_map
