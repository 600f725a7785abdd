#include <semantic_driving/DriveController.h>
#include <semantic_driving/DynamicObstacles.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "StepAside.h"

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::PathPoint;

namespace {

// For MRPT's navigator: between waypoints, how near is near enough, and what room around the
// footprint they have, or are left out; m.
constexpr double kWaypointSpacing = 1.2, kWaypointReach = 0.5, kWaypointMargin = 0.3;
constexpr double kReactivePause = 2;  // s until it is asked again after it found no way
// m: stretches and ends of stretches shorter than this follow the path exactly.
constexpr double kExactEnd = 2;

/** Where a vehicle is after some seconds, from a pose on. */
TPose2D after(const TPose2D& pose, const DriveCommand& c, double seconds) {
  const double way = c.speed * seconds, heading = pose.phi + c.turn * seconds / 2;
  return {pose.x + way * std::cos(heading), pose.y + way * std::sin(heading),
          pose.phi + c.turn * seconds};
}

}  // namespace

DriveController::DriveController(const DriveOptions& options,
                                 const ReactiveNavigator::Options& reactive)
    : m_tracker(options, reactive.footprint), m_reactive(reactive, options) {}

void DriveController::setPath(DrivePath path) {
  m_tracker.setPath(std::move(path));
  m_reactiveFrom = -1;
}

DriveCommand DriveController::step(const DriveState& state, const ObstaclePoints& obstacles,
                                   double sensorAge, double seconds, const DynamicObstacles& movers,
                                   const ObstaclePoints* room) {
  m_track.add(state.pose);
  m_tracker.locate(state);
  const double limit = m_tracker.options().speedFor(sensorAge);
  m_isReactive = seconds >= m_reactiveAgain && wantsReactive(state, obstacles);
  if (!m_isReactive) m_reactiveFrom = -1;
  DriveCommand wanted =
      besideMovers(state,
                   m_isReactive ? driveReactively(state, obstacles, limit, seconds)
                                : m_tracker.command(state, obstacles, limit),
                   movers);
  if (room && std::abs(wanted.speed) <= DriveOptions::kSlowest)
    wanted = stepAside(state, m_motion, *room, movers, m_tracker.footprint(), m_tracker.options())
                 .value_or(wanted);
  const double since = seconds - std::exchange(m_steppedAt, seconds).value_or(seconds);
  m_motion = safeMotion(state, wanted, obstacles, since);
  if (std::abs(m_motion.speed) > DriveOptions::kAtRest || m_tracker.finished()) m_movedAt = seconds;
  return m_motion.command();
}

/** Something stands in the planned way. */
bool DriveController::wantsReactive(const DriveState& state,
                                    const ObstaclePoints& obstacles) const {
  if (m_tracker.finished()) return false;
  const DrivePath& path = m_tracker.path();
  const double here = m_tracker.progress(), left = path.stretchEnd(here) - here;
  if (!path.at(here + 1e-3).forward || left < kExactEnd) return false;
  return m_tracker.freeAhead(state, obstacles) < std::min(left, m_tracker.options().lookAhead());
}

bool DriveController::isOpen(const PathPoint& place, const DriveState& state,
                             const ObstaclePoints& obstacles) const {
  return m_tracker.isFree(poseOf(place) - state.pose, obstacles, kWaypointMargin);
}

/** To the end of the stretch, without those where something stands: they cannot be reached. */
void DriveController::setWaypoints(const DriveState& state, const ObstaclePoints& obstacles) {
  m_waypoints = m_tracker.path().waypoints(m_tracker.progress(), kWaypointSpacing);
  m_waypoints.erase(
      std::remove_if(m_waypoints.begin(), m_waypoints.end() - 1,
                     [&](const PathPoint& p) { return !isOpen(p, state, obstacles); }),
      m_waypoints.end() - 1);
  m_reactive.setWaypoints(m_waypoints, kWaypointReach);
}

DriveCommand DriveController::driveReactively(const DriveState& state,
                                              const ObstaclePoints& obstacles, double speedLimit,
                                              double seconds) {
  const DrivePath& path = m_tracker.path();
  const double here = m_tracker.progress(), begin = path.stretchBegin(here + 1e-3);
  const bool blocked =
      m_waypoints.size() > 1 &&
      std::any_of(m_waypoints.begin(), m_waypoints.end() - 1, [&](const PathPoint& p) {
        return p.arcLength > here && !isOpen(p, state, obstacles);
      });
  if (m_reactiveFrom != begin || blocked) setWaypoints(state, obstacles);
  m_reactiveFrom = begin;
  DriveCommand c = m_reactive.step(state, obstacles, seconds);
  if (m_reactive.status() != ReactiveNavigator::Status::Driving) {
    m_reactiveAgain = seconds + kReactivePause;
    return m_tracker.command(state, obstacles, speedLimit);
  }
  const double curve = std::sqrt(m_tracker.options().maxAcceleration *
                                 std::abs(c.speed / std::max(1e-6, std::abs(c.turn))));
  const double onPath = m_tracker.speedBefore(m_tracker.options().lookAhead(), speedLimit);
  const double speed = std::min({c.speed, onPath, curve});
  if (c.speed > 0) c.turn *= speed / c.speed;
  c.speed = speed;
  return c;
}

/** Where it is after some meters: beside its path as now, or on the arc that MRPT chose. */
std::function<TPose2D(double)> DriveController::wayAhead(const DriveState& state,
                                                         const DriveCommand& wanted) const {
  if (m_isReactive)
    return [=](double way) { return after(state.pose, wanted, way / std::abs(wanted.speed)); };
  const DrivePath& path = m_tracker.path();
  const double here = m_tracker.progress(), end = path.stretchEnd(here);
  const PathPoint p = path.at(here);
  const double dx = state.pose.x - p.x, dy = state.pose.y - p.y;
  return [&path, here, end, dx, dy](double way) {
    const TPose2D pose = poseOf(path.at(std::min(here + way, end)));
    return TPose2D(pose.x + dx, pose.y + dy, pose.phi);
  };
}

DriveCommand DriveController::besideMovers(const DriveState& state, DriveCommand wanted,
                                           const DynamicObstacles& movers) const {
  if (wanted.speed == 0 || movers.empty()) return wanted;
  const double forward = std::copysign(1.0, wanted.speed), speed = std::abs(wanted.speed);
  const double most = separationSpeed(wayAhead(state, wanted), std::max(0.0, forward * state.speed),
                                      forward * m_motion.acceleration, speed, movers,
                                      m_tracker.footprint(), m_tracker.options());
  wanted.speed *= most / speed;
  wanted.turn *= most / speed;
  return wanted;
}

/** The motion that is wanted; or a slow one, so that the steering gets there in time to miss what
 * is in the way; or a stop. \param since seconds since the last motion */
Motion DriveController::safeMotion(const DriveState& state, const DriveCommand& wanted,
                                   const ObstaclePoints& obstacles, double since) const {
  const DriveOptions& options = m_tracker.options();
  const double slow =
      std::min(1.0, DriveOptions::kSlowest / std::max(1e-9, std::abs(wanted.speed)));
  for (const double share : {1.0, slow}) {
    const DriveCommand command{share * wanted.speed, share * wanted.turn};
    const Motion motion = next(m_motion, command, state.speed, since, options);
    Motion later = motion;
    later.speed = command.speed;
    if (isSafe(motion, command, obstacles) && isSafe(later, command, obstacles)) return motion;
  }
  return next(m_motion, {}, state.speed, since, options);
}

/** Whether it could still stop, if it does so after its time of reaction: the steering turns as it
 * is wanted, and then stays. */
bool DriveController::isSafe(Motion motion, const DriveCommand& wanted,
                             const ObstaclePoints& obstacles) const {
  constexpr double kStep = 0.1;  // s
  const DriveOptions& options = m_tracker.options();
  const double margin = options.margin / 2;
  if (!m_tracker.isFree({}, obstacles, margin))  // it has to get out, not further in
    return !m_tracker.approaches(motion.command(), obstacles, margin);
  const double faster = motion.speed < 0 ? -motion.acceleration : motion.acceleration;
  const double reaction = options.reactionTime + delayOfStop(faster, options);
  TPose2D pose;
  for (double t = kStep; motion.speed != 0; t += kStep) {
    if (t < reaction)
      motion = steered(motion, wanted, kStep, options);
    else
      motion.speed -= std::clamp(motion.speed, -options.maxAcceleration * kStep,
                                 options.maxAcceleration * kStep);
    pose = after(pose, motion.command(), kStep);
    if (!m_tracker.isFree(pose, obstacles, margin)) return false;
  }
  return true;
}

}  // namespace semantic_driving
