#pragma once
#include <semantic_driving/DriveOptions.h>
#include <semantic_driving/Motion.h>
#include <semantic_driving/Movers.h>
#include <semantic_planning/vehicle/Footprint.h>

#include <functional>

namespace semantic_driving {

/** Speed and separation: the highest speed up to a wanted one at which nobody who moves on as now
 * meets a vehicle that moves.
 *
 * For each of those who move the speed must be such that
 * - while the vehicle brakes to a standstill, after its time of reaction, nobody's predicted place
 *   touches it before it is as slow as DriveOptions::kSlowest. The place grows with what is not
 *   known of the velocity. This is passive safety: if there is contact, the vehicle is at rest.
 *   (Bouraine, Fraichard and Salhi, "Provably safe navigation for mobile robots with limited
 *   field-of-views in dynamic environments", 2012; that persons come on during reaction and
 *   braking is ISO 13855's distance.)
 * - nobody who walks meets the vehicle where it would stand then, either, for a
 *   second, or else not where it would be if it went on. So it lets others pass, or passes before
 *   them, and goes on beside and behind them.
 *
 * Where braking comes too late it goes on if that helps.
 * \param poseAfter where the vehicle is after some meters along its way, map frame
 * \param speed, acceleration now along the way, m/s and m/s^2, not negative for the speed
 * \param wanted m/s, not negative
 * \param movers now, map frame
 * \return 0 to wanted, m/s */
double separationSpeed(const std::function<mrpt::math::TPose2D(double)>& poseAfter, double speed,
                       double acceleration, double wanted, const Movers& movers,
                       const semantic_planning::Footprint& footprint, const DriveOptions& options);

}  // namespace semantic_driving
