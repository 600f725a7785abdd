#pragma once
#include <mrpt/maps/CMetricMap.h>
#include <mrpt/version.h>

/** \file
 * What differs between the releases of MRPT; everything else compiles with all of them. What
 * differs for CMake stands in cmake/Dependencies.cmake. */

/** MRPT_VERSION counts 0x258 for 2.5.8, and (major << 16) | (minor << 8) | patch from 2.10.2 on, so
 * that this comparison holds for both. */
#define MSO_MRPT_AT_LEAST(MAJOR, MINOR, PATCH) \
  (MRPT_VERSION >= (((MAJOR) << 16) | ((MINOR) << 8) | (PATCH)))

/** CMetricMap has no boundingBox() before. */
#if MSO_MRPT_AT_LEAST(2, 11, 3)
#define MSO_OVERRIDE_SINCE_2_11_3 override
#else
#define MSO_OVERRIDE_SINCE_2_11_3
#endif

namespace semantic_map {

#if MSO_MRPT_AT_LEAST(2, 11, 3)
/** What a map's factory function returns. */
using CreatedMap = mrpt::maps::CMetricMap::Ptr;
#else
using CreatedMap = mrpt::maps::CMetricMap*;
#endif

}  // namespace semantic_map
