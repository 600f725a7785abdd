#pragma once
#include <mrpt/maps/CMetricMap.h>
#include <mrpt_compat/Release.h>

/** CMetricMap has no boundingBox() before. */
#if MSO_MRPT_AT_LEAST(2, 11, 3)
#define MSO_OVERRIDE_SINCE_2_11_3 override
#else
#define MSO_OVERRIDE_SINCE_2_11_3
#endif

namespace mrpt_compat {

#if MSO_MRPT_AT_LEAST(2, 11, 3)
/** What a map's factory function returns. */
using CreatedMap = mrpt::maps::CMetricMap::Ptr;
#else
using CreatedMap = mrpt::maps::CMetricMap*;
#endif

}  // namespace mrpt_compat
