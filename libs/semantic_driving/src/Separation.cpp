#include <semantic_driving/Movers.h>

#include <algorithm>
#include <array>
#include <cmath>

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
  bool canStop(double target, const Mover& mover) const {
    double speed = m_speed, way = 0;
    for (double t = 0; t < m_reaction || speed > DriveOptions::kSlowest; t += kTick) {
      if (speed > kSlow * DriveOptions::kSlowest && touches(mover, way, t, spreadAfter(mover, t)))
        return false;
      move(speed, way, t < m_reaction ? target : 0);
    }
    return true;
  }
  /** Nobody who walks touches it as it brakes, nor later where it stands. */
  bool isFreeAtRest(double target, const Mover& mover) const {
    return isFree(target, mover, true, false);
  }
  /** Nobody touches it as it goes on, as long as that.
   * \param spreads the place grows with what is not known */
  bool isFreeAhead(double target, const Mover& mover, bool spreads) const {
    return isFree(target, mover, false, spreads);
  }

 private:
  static constexpr double kSlow = 1.05;  // of DriveOptions::kSlowest

  bool isFree(double target, const Mover& mover, bool brakes, bool spreads) const {
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
  double spreadAfter(const Mover& mover, double seconds) const {
    return std::min(kSpread, mover.speedNoise * seconds);
  }
  bool touches(const Mover& mover, double way, double seconds, double spread) const {
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

/** Who stands is an obstacle like others. */
bool letsPass(const Forecast& forecast, double target, const Mover& mover) {
  return mover.stands() || forecast.isFreeAhead(target, mover, false) ||
         forecast.isFreeAtRest(target, mover);
}

double speedBeside(const Forecast& forecast, const Mover& mover, double wanted, double slowest) {
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
                       double acceleration, double wanted, const Movers& movers,
                       const semantic_planning::Footprint& footprint, const DriveOptions& options) {
  const Forecast forecast(poseAfter, speed, acceleration, footprint, options);
  double slowest = wanted;
  for (const Mover& mover : movers)
    slowest = std::min(slowest, speedBeside(forecast, mover, wanted, DriveOptions::kSlowest));
  return slowest;
}

}  // namespace semantic_driving
