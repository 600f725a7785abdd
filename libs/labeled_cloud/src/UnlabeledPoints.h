#pragma once
#include <mrpt/obs/CObservation.h>

#include <Eigen/Core>
#include <vector>

namespace labeled_cloud {

/** Points in the sensor's frame of an observation that says where something is, but not what:
 * CObservationPointCloud, CObservationVelodyneScan, CObservation2DRangeScan. What was no return is
 * (0, 0, 0) or not finite.
 * \throw std::invalid_argument it is of another class, or holds nothing. */
std::vector<Eigen::Vector3f> unlabeledPoints(const mrpt::obs::CObservation& observation);

/** Whether unlabeledPoints() knows observations of this class. */
bool hasUnlabeledPoints(const mrpt::obs::CObservation& observation);

}  // namespace labeled_cloud
