#pragma once
#include <labeled_cloud/ScanConverter.h>

namespace labeled_cloud {

/** The source that reads this observation, null if there is none. */
std::shared_ptr<const PointSource> pointSourceOf(const mrpt::obs::CObservation& observation);

}  // namespace labeled_cloud
