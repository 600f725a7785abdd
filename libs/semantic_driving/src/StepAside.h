#pragma once
#include <semantic_driving/DriveOptions.h>
#include <semantic_driving/DynamicObstacles.h>
#include <semantic_planning/vehicle/Footprint.h>

#include <optional>

namespace semantic_driving {

/** What takes a vehicle out of the way of those who walk into it. Arcs both ways, driven for some
 * time, are compared with coming to rest. What keeps walkers farthest away wins, up to
 * DriveOptions::kMoverMargin; among equals the shortest. People go on as they walk now.
 * \param motion now \param room what the vehicle must not touch: obstacles, and what is not known
 * to be ground; vehicle's frame \param movers map frame
 * \return nothing if nobody walks into it, or nothing helps */
std::optional<DriveCommand> stepAside(const DriveState& state, const Motion& motion,
                                      const ObstaclePoints& room, const DynamicObstacles& movers,
                                      const semantic_planning::Footprint& footprint,
                                      const DriveOptions& options);

}  // namespace semantic_driving
