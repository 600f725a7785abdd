#include <semantic_driving/PathTracker.h>

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::PathPoint;

namespace {

constexpr double kLookStep = 0.15;      // m between poses on the way ahead that are looked at
constexpr double kStandoff = 0.3;       // m from where it stops to what stands in the way
constexpr double kPathEnd = 0.04;       // m; stretches end when no more than this is left
constexpr double kSideGain = 1.2;       // 1/m^2, of the steering, for a place off the path
constexpr double kHeadingGain = 2;      // 1/m, of the steering, for a heading off the path's
constexpr double kCurvatureOver = 0.6;  // m that the path's curvature is a mean over
// Until the steering has an effect, s: so far ahead the path's curvature is taken.
constexpr double kSteeringDelay = 0.15;
// How far ahead of its last place on the path, and back, the vehicle is looked for, m.
constexpr double kSearchAhead = 1.5, kSearchBack = 0.3;

}  // namespace

PathTracker::PathTracker(const DriveOptions& options, semantic_planning::Footprint footprint)
    : m_options(options), m_footprint(std::move(footprint)) {
  m_options.validate();
}

void PathTracker::setPath(DrivePath path) {
  m_path = std::move(path);
  m_progress = m_offset = 0;
}

bool PathTracker::finished() const {
  return m_path.empty() || m_progress >= m_path.length() - kPathEnd;
}

void PathTracker::locate(const DriveState& state) {
  if (m_path.empty()) return;
  const double end = m_path.stretchEnd(m_progress);
  const double from =
      std::max(m_path.stretchBegin(m_progress + kPathEnd), m_progress - kSearchBack);
  m_progress = m_path.nearest(state.pose, std::min(from, m_progress),
                              std::min(end, m_progress + kSearchAhead));
  if (end - m_progress < kPathEnd && end < m_path.length()) m_progress = end;
  const PathPoint p = m_path.at(m_progress);
  m_offset = std::hypot(p.x - state.pose.x, p.y - state.pose.y);
}

bool PathTracker::isFree(const TPose2D& relative, const ObstaclePoints& obstacles,
                         double margin) const {
  const double c = std::cos(relative.phi), s = std::sin(relative.phi);
  return std::none_of(obstacles.begin(), obstacles.end(), [&](const Eigen::Vector2d& o) {
    const double x = o.x() - relative.x, y = o.y() - relative.y;
    return m_footprint.distance({c * x + s * y, c * y - s * x}) < margin;
  });
}

bool PathTracker::approaches(const DriveCommand& command, const ObstaclePoints& obstacles,
                             double margin) const {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : m_footprint)
    middle += corner / static_cast<double>(m_footprint.size());
  return std::any_of(obstacles.begin(), obstacles.end(), [&](const Eigen::Vector2d& o) {
    const Eigen::Vector2d motion(command.speed - command.turn * o.y(), command.turn * o.x());
    return m_footprint.distance(o) < margin && motion.dot(o - middle) > 1e-6;
  });
}

double PathTracker::freeAhead(const DriveState& state, const ObstaclePoints& obstacles) const {
  const double most = std::min(m_options.lookAhead(), m_path.stretchEnd(m_progress) - m_progress);
  if (most <= 0) return 0;
  // What is within the margin already does not keep the vehicle from driving away from it.
  const double margin = isFree({}, obstacles, m_options.margin) ? m_options.margin : 0;
  for (double ahead = kLookStep; ahead < most + kLookStep; ahead += kLookStep) {
    const TPose2D pose = poseOf(m_path.at(m_progress + std::min(ahead, most)));
    const TPose2D relative = pose - state.pose;
    if (!isFree(relative, obstacles, margin)) return ahead - kLookStep;
  }
  return most;
}

/** The steering's curvature, a mean over some of the stretch: no steering turns at once. */
double PathTracker::curvatureAt(double s) const {
  const double half = kCurvatureOver / 2;
  const double from = std::max(s - half, m_path.stretchBegin(s));
  const double to = std::min(s + half, m_path.stretchEnd(s));
  if (to - from < kPathEnd) return m_path.at(s).curvature;
  const PathPoint a = m_path.at(from), b = m_path.at(to);
  const double turned = mrpt::math::wrapToPi(b.heading - a.heading) / (to - from);
  return a.forward ? turned : -turned;
}

/** What curve, steering and class allow at a place of the path. */
double PathTracker::speedAt(double s) const {
  constexpr double kStep = 0.1;  // m
  const PathPoint place = m_path.at(s);
  const double bend = curvatureAt(s);
  const double curve = std::max(std::abs(bend), 1e-6);
  const double change = std::max(std::abs(curvatureAt(s + kStep) - bend) / kStep, 1e-6);
  const double onClass =
      place.classId < m_classSpeeds.size() ? m_classSpeeds[place.classId] : m_options.maxSpeed;
  return std::max(DriveOptions::kSlowest,
                  std::min({onClass, std::sqrt(m_options.maxAcceleration / curve),
                            m_options.steeringRate() / change}));
}

double PathTracker::speedBefore(double free, double limit) const {
  constexpr double kStep = 0.1;  // m
  const double braking = m_options.braking();
  const double left = m_path.stretchEnd(m_progress) - m_progress;
  double speed = std::min(limit, std::max(DriveOptions::kSlowest, std::sqrt(2 * braking * left)));
  if (free < m_options.lookAhead() && free < left)
    speed = std::min(speed, std::sqrt(2 * braking * std::max(0.0, free - kStandoff)));
  for (double ahead = 0; ahead < left && 2 * braking * ahead < speed * speed; ahead += kStep) {
    const double there = speedAt(m_progress + ahead + 1e-3);
    speed = std::min(speed, std::sqrt(there * there + 2 * braking * ahead));
  }
  return speed;
}

DriveCommand PathTracker::command(const DriveState& state, const ObstaclePoints& obstacles,
                                  double speedLimit) const {
  if (finished()) return {};
  const double here = m_progress + 1e-3, ahead = std::abs(state.speed) * kSteeringDelay;
  PathPoint place = m_path.at(here);
  place.curvature = curvatureAt(std::min(here + ahead, m_path.stretchEnd(here) - 1e-3));
  const double speed = speedBefore(freeAhead(state, obstacles), speedLimit);
  const double v = place.forward ? speed : -speed;
  const double dx = state.pose.x - place.x, dy = state.pose.y - place.y;
  const double side = dy * std::cos(place.heading) - dx * std::sin(place.heading);
  const double heading = mrpt::math::wrapToPi(state.pose.phi - place.heading);
  const double sinc = std::abs(heading) < 1e-6 ? 1 : std::sin(heading) / heading;
  const double bend = std::max(0.3, 1 - place.curvature * side);
  const double turn = v * place.curvature * std::cos(heading) / bend - kSideGain * v * side * sinc -
                      kHeadingGain * std::abs(v) * heading;
  const double most = std::abs(v) / m_options.turningRadius;
  return {v, std::clamp(turn, -most, most)};
}

using semantic_octree::Region;

namespace {

/** In the middle of the meter that it is in: it moves rarely. */
Eigen::Vector3d onMeters(const Eigen::Vector3d& place) { return place.array().floor() + 0.5; }

Eigen::Vector3d placeAt(const DrivePath& path, double s) {
  const semantic_planning::PathPoint p = path.at(s);
  return {p.x, p.y, p.z};
}

}  // namespace

void FocusOptions::describe(strict_files::OptionList& list) {
  list.add("corridor", corridor, "m", strict_files::atLeast(0),
           "on both sides of the path ahead, where the compressed tree has detail; 0: everywhere");
}

void FocusOptions::validate() const { strict_files::checkOptions(*this, "FocusOptions"); }

std::vector<Region> regionsAhead(const DrivePath& path, double progress,
                                 const Eigen::Vector3d& vehicle, const FocusOptions& options) {
  constexpr double kFar = 1e6, kStretch = 3;  // m
  constexpr double kAhead = 15;               // m of the path
  if (!options.isOn()) return {};
  const Eigen::Vector3d far = Eigen::Vector3d::Constant(kFar);
  std::vector<Region> regions = {
      {Region::Shape::Box, -far, far, 0, 0},
      {Region::Shape::Sphere, onMeters(vehicle), far, options.around + std::sqrt(0.75), 1}};
  const double end = path.empty() ? 0 : std::min(path.length(), progress + kAhead);
  for (double s = kStretch * std::floor(progress / kStretch); s < end; s += kStretch)
    regions.push_back({Region::Shape::Corridor, placeAt(path, s), placeAt(path, s + kStretch),
                       options.corridor, 1});
  return regions;
}

}  // namespace semantic_driving
