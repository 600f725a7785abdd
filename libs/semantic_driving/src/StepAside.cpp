#include "StepAside.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace semantic_driving {

namespace {

constexpr double kSoon = 3;        // s: who does not come that soon may walk elsewhere yet
constexpr double kStepTick = 0.1;  // s

/** A way out: an arc, then a stop. */
struct WayOut {
  double speed = 0, curvature = 0;  ///< m/s, 1/m
  double seconds = 0;               ///< until it brakes
};

class WaysOut {
 public:
  WaysOut(const DriveState& state, const Motion& motion, const ObstaclePoints& room,
          const Movers& movers, const semantic_planning::Footprint& footprint,
          const DriveOptions& options)
      : m_state(state), m_motion(motion), m_footprint(footprint), m_options(options) {
    const double reach = options.maxSpeed * kSoon + 1;  // m
    std::copy_if(room.begin(), room.end(), std::back_inserter(m_room),
                 [&](const Eigen::Vector2d& p) { return p.norm() < reach; });
    const double c = std::cos(state.pose.phi), s = std::sin(state.pose.phi);
    for (Mover mover : movers) {
      if (mover.stands()) continue;
      const Eigen::Vector2d& v = mover.velocity;
      const auto place = state.pose.inverseComposePoint({mover.place.x(), mover.place.y()});
      mover.place = {place.x, place.y};
      mover.velocity = {c * v.x() + s * v.y(), c * v.y() - s * v.x()};
      m_walkers.push_back(mover);
    }
  }

  bool isSomebodyWalking() const { return !m_walkers.empty(); }

  /** How near anybody comes, meters, at most the margin for them; less than nothing if something is
   * in the way. */
  double distance(const WayOut& way) const {
    double least = DriveOptions::kMoverMargin;
    Motion motion = m_motion;
    mrpt::math::TPose2D pose;
    double speed = m_state.speed;
    for (double t = 0; t < kSoon && least > -1; t += kStepTick) {
      for (const Mover& w : m_walkers) least = std::min(least, distanceTo(w, pose, t));
      const double wanted = t < way.seconds ? way.speed : 0;
      motion = next(motion, {wanted, wanted * way.curvature}, speed, kStepTick, m_options);
      speed = motion.speed;
      if (std::abs(speed) < 1e-3) continue;
      pose = pose + mrpt::math::TPose2D(speed * kStepTick, 0, speed * motion.curvature * kStepTick);
      if (way.speed != 0 && !isFree(pose)) return -1;
    }
    return least;
  }

 private:
  double distanceTo(const Mover& w, const mrpt::math::TPose2D& pose, double seconds) const {
    const Eigen::Vector2d place = w.placeAfter(seconds);
    const auto p = pose.inverseComposePoint({place.x(), place.y()});
    return m_footprint.distance({p.x, p.y}) - w.size;
  }
  bool isFree(const mrpt::math::TPose2D& pose) const {
    return std::none_of(m_room.begin(), m_room.end(), [&](const Eigen::Vector2d& o) {
      const auto p = pose.inverseComposePoint({o.x(), o.y()});
      return m_footprint.distance({p.x, p.y}) < m_options.margin;
    });
  }

  const DriveState& m_state;
  const Motion& m_motion;
  const semantic_planning::Footprint& m_footprint;
  const DriveOptions& m_options;
  ObstaclePoints m_room;
  Movers m_walkers;  ///< vehicle's frame
};

}  // namespace

std::optional<DriveCommand> stepAside(const DriveState& state, const Motion& motion,
                                      const ObstaclePoints& room, const Movers& movers,
                                      const semantic_planning::Footprint& footprint,
                                      const DriveOptions& options) {
  constexpr double kGain = 0.1;  // m: less is not worth it
  const WaysOut ways(state, motion, room, movers, footprint, options);
  if (!ways.isSomebodyWalking()) return {};
  double best = ways.distance({}) + kGain;
  if (best >= DriveOptions::kMoverMargin) return {};
  std::optional<DriveCommand> command;
  const double tightest = 1 / options.turningRadius;
  for (const double seconds : {0.5, 1.0, 1.5, 2.0, kSoon})
    for (const double bend : {0.0, tightest / 2, -tightest / 2, tightest, -tightest})
      for (const double speed : {options.maxSpeed, -options.maxSpeed}) {
        const double distance = ways.distance({speed, bend, seconds});
        if (distance <= best) continue;
        best = distance;
        command = DriveCommand{speed, speed * bend};
      }
  return command;
}

}  // namespace semantic_driving
