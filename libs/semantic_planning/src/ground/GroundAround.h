#pragma once
#include <semantic_planning/ground/Ground.h>
#include <semantic_planning/vehicle/PathPoint.h>

#include <optional>
#include <vector>

namespace semantic_planning {

/** What a vehicle stands on where the map knows no ground: a LiDAR on its roof does not see what is
 * near. Ground that is known all around, within 10 m, tells height and class.
 * \param z height of the vehicle's origin, meters; none: as the ground around
 * \return the columns of the footprint and the clearance around it in which the map has no surface;
 * none if ground is not known on all four sides, or is forbidden */
std::vector<GroundPoint> groundBelow(const Ground& ground, const VehicleOptions& vehicle,
                                     const mrpt::math::TPose2D& pose, std::optional<double> z);

}  // namespace semantic_planning
