#include <semantic_driving/DynamicObstacles.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "StepAside.h"

namespace semantic_driving {
namespace {

constexpr double kTick = 0.1;    // s
constexpr double kLinger = 1;    // s that those who walk find it at rest where they do not walk
constexpr double kSpread = 0.5;  // m, at most, for what is not known of how they walk

/** A vehicle that goes on along its way, or brakes after its time of reaction. */
class Forecast {
 public:
  Forecast(const std::function<mrpt::math::TPose2D(double)>& poseAfter, double speed,
           double acceleration, const semantic_planning::Footprint& footprint,
           const DriveOptions& options)
      : m_poseAfter(poseAfter),
        m_speed(speed),
        m_reaction(options.reactionTime + delayOfStop(acceleration, options)),
        m_footprint(footprint),
        m_options(options) {}

  /** Nobody touches it as it brakes, while it is not slow. */
  bool canStop(double target, const DynamicObstacle& mover) const {
    double speed = m_speed, way = 0;
    for (double t = 0; t < m_reaction || speed > DriveOptions::kSlowest; t += kTick) {
      if (speed > kSlow * DriveOptions::kSlowest && touches(mover, way, t, spreadAfter(mover, t)))
        return false;
      move(speed, way, t < m_reaction ? target : 0);
    }
    return true;
  }
  /** Nobody who walks touches it as it brakes, nor later where it stands. */
  bool isFreeAtRest(double target, const DynamicObstacle& mover) const {
    return isFree(target, mover, true, false);
  }
  /** Nobody touches it as it goes on, as long as that.
   * \param spreads the place grows with what is not known */
  bool isFreeAhead(double target, const DynamicObstacle& mover, bool spreads) const {
    return isFree(target, mover, false, spreads);
  }

 private:
  static constexpr double kSlow = 1.05;  // of DriveOptions::kSlowest

  bool isFree(double target, const DynamicObstacle& mover, bool brakes, bool spreads) const {
    const double last = m_reaction + std::max(m_speed, target) / m_options.braking() + kLinger;
    double speed = m_speed, way = 0;
    for (double t = 0; t < last; t += kTick) {
      if (touches(mover, way, t, spreads ? spreadAfter(mover, t) : 0)) return false;
      move(speed, way, brakes && t >= m_reaction ? 0 : target);
    }
    return true;
  }

  void move(double& speed, double& way, double target) const {
    const double most = m_options.braking() * kTick;
    const double before = speed;
    speed += std::clamp(target - speed, -most, most);
    way += (before + speed) / 2 * kTick;
  }
  double spreadAfter(const DynamicObstacle& mover, double seconds) const {
    return std::min(kSpread, mover.speedNoise * seconds);
  }
  bool touches(const DynamicObstacle& mover, double way, double seconds, double spread) const {
    const Eigen::Vector2d place = mover.placeAfter(seconds);
    const auto p = m_poseAfter(way).inverseComposePoint({place.x(), place.y()});
    const double margin = mover.stands() ? 0 : DriveOptions::kMoverMargin;
    return m_footprint.distance({p.x, p.y}) < mover.size + margin + spread;
  }

  const std::function<mrpt::math::TPose2D(double)>& m_poseAfter;
  double m_speed, m_reaction;
  const semantic_planning::Footprint& m_footprint;
  const DriveOptions& m_options;
};

/** A person who stands is an obstacle like others. */
bool letsPass(const Forecast& forecast, double target, const DynamicObstacle& mover) {
  return mover.stands() || forecast.isFreeAhead(target, mover, false) ||
         forecast.isFreeAtRest(target, mover);
}

double speedBeside(const Forecast& forecast, const DynamicObstacle& mover, double wanted,
                   double slowest) {
  std::array<double, 8> speeds{};
  for (std::size_t i = 0; i < speeds.size(); ++i)
    speeds[i] = wanted * (1 - static_cast<double>(i) / speeds.size());
  speeds.back() = std::min(wanted, slowest);
  if (!forecast.canStop(0, mover)) {
    const auto past = std::find_if(speeds.begin(), speeds.end(),
                                   [&](double v) { return forecast.isFreeAhead(v, mover, true); });
    return past == speeds.end() ? 0 : *past;
  }
  const auto fit = std::find_if(speeds.begin(), speeds.end(), [&](double v) {
    return forecast.canStop(v, mover) && letsPass(forecast, v, mover);
  });
  return fit == speeds.end() ? 0 : *fit;
}

}  // namespace

double separationSpeed(const std::function<mrpt::math::TPose2D(double)>& poseAfter, double speed,
                       double acceleration, double wanted, const DynamicObstacles& movers,
                       const semantic_planning::Footprint& footprint, const DriveOptions& options) {
  const Forecast forecast(poseAfter, speed, acceleration, footprint, options);
  double slowest = wanted;
  for (const DynamicObstacle& mover : movers)
    slowest = std::min(slowest, speedBeside(forecast, mover, wanted, DriveOptions::kSlowest));
  return slowest;
}

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
          const DynamicObstacles& movers, const semantic_planning::Footprint& footprint,
          const DriveOptions& options)
      : m_state(state), m_motion(motion), m_footprint(footprint), m_options(options) {
    const double reach = options.maxSpeed * kSoon + 1;  // m
    std::copy_if(room.begin(), room.end(), std::back_inserter(m_room),
                 [&](const Eigen::Vector2d& p) { return p.norm() < reach; });
    const double c = std::cos(state.pose.phi), s = std::sin(state.pose.phi);
    for (DynamicObstacle mover : movers) {
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
      for (const DynamicObstacle& w : m_walkers) least = std::min(least, distanceTo(w, pose, t));
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
  double distanceTo(const DynamicObstacle& w, const mrpt::math::TPose2D& pose,
                    double seconds) const {
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
  DynamicObstacles m_walkers;  ///< vehicle's frame
};

}  // namespace

std::optional<DriveCommand> stepAside(const DriveState& state, const Motion& motion,
                                      const ObstaclePoints& room, const DynamicObstacles& movers,
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
