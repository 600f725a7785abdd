#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "SlamEngine.h"

namespace semantic_slam {
namespace {

/** Share of the information that a registration's points would have if each were off by itself. */
constexpr double kOwnInformation = 0.5;
/** Information (1/m^2, 1/rad^2) of a height and a tilt that are known. */
constexpr double kLevel = 1e12;
/** Shares of a scan's points that fit: too few say nothing, most say more than wheels do. */
constexpr double kFits = 0.5, kFitsWell = 0.8;
/** Points beyond it, m, are not registered: there beams are far apart, and thin surfaces too. */
constexpr double kFarthest = 30;
/** Share of a scan's points where the last keyframes have some. */
constexpr double kTracked = 0.3;
/** Robots whose sensors see space have better odometry than those of laser scanners. */
constexpr double kInSpace = 0.2;
/** A scan that fits badly is believed up to so many standard deviations of the prediction. */
constexpr double kFar = 4;
/** Steps are small up to this share of what makes a keyframe; so many are not registered. */
constexpr double kSmall = 1.0 / 8;
constexpr int kMostSmall = 10;
/** Least share of the highest score where a scan is searched around its prediction. */
constexpr double kTrackedScore = 0.4;
/** Without odometry, after so many scans in a row that fit nothing, what follows begins anew. */
constexpr int kMostLost = 3;

Eigen::Isometry3d planar(const Eigen::Isometry3d& T) { return poseOfFlat(flatOf(T)); }

double wayOf(const Eigen::Isometry3d& T) { return T.translation().norm(); }
double turnOf(const Eigen::Isometry3d& T) { return vectorOf(T).tail<3>().norm(); }

/** Whether a motion is more standard deviations away than a scan that fits badly may be. */
bool isBeyond(const Vector6& off, const Matrix6& information) {
  return off.head<3>().norm() > kFar / std::sqrt(information(0, 0)) ||
         off.tail<3>().norm() > kFar / std::sqrt(information(5, 5));
}

}  // namespace

LabeledCloud moved(LabeledCloud cloud, const Eigen::Isometry3d& T) {
  for (Eigen::Vector3f& p : cloud.points) p = (T * p.cast<double>()).cast<float>();
  return cloud;
}

Eigen::Vector3d flatOf(const Eigen::Isometry3d& T) {
  return {T(0, 3), T(1, 3), std::atan2(T(1, 0), T(0, 0))};
}

Eigen::Isometry3d poseOfFlat(const Eigen::Vector3d& flat, double z) {
  Eigen::Isometry3d T(Eigen::Translation3d(flat[0], flat[1], z));
  T.rotate(Eigen::AngleAxisd(flat[2], Eigen::Vector3d::UnitZ()));
  return T;
}

Slam::Added SlamEngine::add(const SensorScan& scan, const std::optional<Pose>& T_odometry_robot,
                            double seconds) {
  const bool isVelocityKnown = !m_keyframes.empty() && m_first.times.empty();
  if (scan.times.empty() || !isVelocityKnown) return addAsOf(0, scan, T_odometry_robot, seconds);
  const double middle = std::accumulate(scan.times.begin(), scan.times.end(), 0.0) /
                        static_cast<double>(scan.times.size());
  std::optional<Pose> T_odometry_middle;
  if (T_odometry_robot) T_odometry_middle = *T_odometry_robot * movedFor(middle, m_velocity);
  Slam::Added added = addAsOf(middle, scan, T_odometry_middle, seconds + middle);
  added.T_keyframe_robot = added.T_keyframe_robot * movedFor(-middle, added.velocity);
  return added;
}

Slam::Added SlamEngine::addAsOf(double middle, const SensorScan& scan,
                                const std::optional<Pose>& T_odometry_robot, double seconds) {
  ++m_report.scans;
  if (m_keyframes.empty()) m_hasOdometry = T_odometry_robot.has_value();
  setScale(scan.cloud, scan.T_robot_sensor);
  if (m_keyframes.empty())
    m_noise = MotionNoise(!m_hasOdometry, m_hasOdometry && !m_scale.isPlanar ? kInSpace : 1);
  const std::size_t last = m_keyframes.size() - 1;
  const double passed = m_keyframes.empty() ? 0 : std::max(0.0, seconds - m_lastSeconds);
  const bool isMeasured = m_unmeasured + passed >= kLeastTimeOfVelocity;
  const auto velocityBy = [&](const Pose& T) {
    return isMeasured ? velocityOf(m_T_unmeasured * T, m_unmeasured + passed) : m_velocity;
  };
  if (!m_hasOdometry && !scan.times.empty()) m_T_step = movedFor(passed, m_velocity);
  const Pose T_step = predictedStep(T_odometry_robot), T_guess = m_T_keyframe_last * T_step;
  const Pose T_odometry = m_keyframes.empty() ? T_odometry_robot.value_or(Pose::Identity())
                                              : T_odometry_robot.value_or(m_poses[last] * T_guess);
  const bool stands = m_hasOdometry && isSmall(T_step) && isSmall(goingOn());
  if (!m_keyframes.empty() && stands && ++m_numSmall < kMostSmall)
    return {last, T_guess, false, false, velocityBy(T_step)};
  m_lastSeconds = seconds;
  Seen now = seenIn(scan, middle, m_velocity, T_odometry);
  if (m_keyframes.empty()) {
    if (!scan.times.empty()) m_first = scan;
    return beginFirst(now);
  }

  const Matrix6 ofPrediction = m_noise.information(T_step);
  auto registered = track(now, T_step);
  if (registered && isMeasured &&
      !m_first.times.empty()) {  // alike skewed, they tell how fast the robot is
    straightenFirst(velocityBy(m_T_keyframe_last.inverse() * registered->T_submap_scan));
    now = seenIn(scan, middle, m_velocity, T_odometry);
    registered = track(now, T_step);
  }
  const Pose T_last_robot = registered ? registered->T_submap_scan : T_guess;
  const Pose T_moved = rigid(m_T_keyframe_last.inverse() * T_last_robot);
  const Matrix6 ofScan =
      registered ? Matrix6(registered->information - ofPrediction) : Matrix6::Zero();
  m_report.way += wayOf(T_moved);
  if (registered && !isHeld(ofScan + levelOf(T_odometry))) m_report.unheld += wayOf(T_moved);
  noteStanding(T_moved);
  registered ? noteFound(T_step, T_last_robot, *registered) : noteLost(T_step);
  m_velocity = velocityBy(m_T_step);
  m_unmeasured = isMeasured ? 0 : m_unmeasured + passed;
  m_T_unmeasured = isMeasured ? Pose::Identity() : m_T_unmeasured * m_T_step;
  m_T_keyframe_last = T_last_robot;
  m_T_odometry_last = T_odometry;
  m_stepScans = 1 + m_numSmall;
  m_numSmall = 0;
  if (!beginsKeyframe(T_last_robot)) return {last, T_last_robot, false, false, m_velocity};
  // Where scans do not hold the robot, what predictions err by since then adds up.
  m_edges.push_back(
      {last, last + 1, T_last_robot,
       registered ? ofScan + m_noise.information(T_last_robot) : guessed(T_last_robot)});
  if (isTorn()) m_local.clear();
  begin(now, rigid(m_poses.back() * T_last_robot), T_last_robot);
  m_looks = kLiveLooks;
  settleDoubt(keyframesBeside());
  const bool joined = joinPiece(), followed = followReference();
  return {last + 1, Pose::Identity(), true, closeLoops() || followed || joined, m_velocity};
}

auto SlamEngine::seenIn(const SensorScan& scan, double middle, const Vector6& velocity,
                        const Pose& T_odometry) const -> Seen {
  const bool isStraight = scan.times.empty();
  const SensorScan straight = isStraight ? SensorScan() : deskewed(scan, velocity, middle);
  Seen seen{moved(thinned((isStraight ? scan : straight).cloud, m_scale.cube, kFarthest),
                  scan.T_robot_sensor),
            T_odometry};
  if (!m_options.useClasses)
    std::fill(seen.cloud.classes.begin(), seen.cloud.classes.end(), semantic_types::kNoClass);
  return seen;
}

void SlamEngine::straightenFirst(const Vector6& velocity) {
  m_velocity = velocity;
  const SensorScan first = std::exchange(m_first, {});
  if (first.times.empty() || m_keyframes.size() > 1) return;
  const Seen seen = seenIn(first, 0, velocity, m_keyframes[0].seen.T_odometry_robot);
  m_keyframes.clear();
  keep(seen);
  m_local.clear();
  m_local.add(seen.cloud, Pose::Identity(), m_scale, m_options.useClasses);
}

void SlamEngine::setScale(const LabeledCloud& cloud, const Pose& T_robot_sensor) {
  const bool isPlanar = m_scale.isPlanar && isHorizontal(cloud, T_robot_sensor);
  if (!m_keyframes.empty() && isPlanar == m_scale.isPlanar) return;
  m_scale = SensorScale::of(moved(cloud, T_robot_sensor), isPlanar);
  // Nothing tells how fast the robot is at first.
  if (!m_hasOdometry && !isPlanar)
    m_scale.cells.insert(m_scale.cells.begin(), {4 * m_scale.cells[0], 2 * m_scale.cells[0]});
  m_local.clear();  // of another sensor
  if (!m_keyframes.empty())
    m_local.add(seenAt(m_keyframes.size() - 1).cloud, Pose::Identity(), m_scale,
                m_options.useClasses);
}

Eigen::Isometry3d SlamEngine::predictedStep(const std::optional<Pose>& T_odometry_robot) {
  if (!T_odometry_robot) return m_T_odometry_step = m_T_step;
  m_T_odometry_step = m_T_odometry_last.inverse() * *T_odometry_robot;
  return m_noise.calibrated(m_T_odometry_step);
}

bool SlamEngine::isSmall(const Pose& T_step) const {
  return wayOf(T_step) < kSmall * m_scale.keyframeDistance &&
         turnOf(T_step) < kSmall * m_scale.keyframeAngle;
}

Eigen::Isometry3d SlamEngine::goingOn() const {
  return poseOf(vectorOf(m_T_step) * (1 + m_numSmall) / m_stepScans);
}

void SlamEngine::noteFound(const Pose& T_step, const Pose& T_last_robot,
                           const Registration& registered) {
  if (m_lostInRow == 0) {
    m_T_step = rigid(m_T_keyframe_last.inverse() * T_last_robot);
    learn(T_step, registered);
  } else {
    const Vector6 since = vectorOf(m_T_keyframe_found.inverse() * T_last_robot);
    m_T_step = poseOf(since / (m_lostInRow + 1));
  }
  m_lostInRow = 0;
  m_T_keyframe_found = T_last_robot;
}

void SlamEngine::noteLost(const Pose& T_step) {
  ++m_report.lost;
  if (!m_doubted && lossIsRare()) m_doubted = m_keyframes.size();
  m_lostWay += wayOf(T_step);
  // Nobody knows whether it goes on so: half way between that and standing.
  m_T_step = poseOf(0.5 * vectorOf(T_step));
  if (++m_lostInRow > kMostLost && !m_hasOdometry && !m_scale.isPlanar) ++m_report.torn;
}

void SlamEngine::noteStanding(const Pose& T_moved) {
  const bool stands = m_hasOdometry && m_T_odometry_step.isApprox(Pose::Identity());
  m_T_standing = stands ? rigid(m_T_standing * T_moved) : Pose::Identity();
  m_report.standing = std::max(m_report.standing, wayOf(m_T_standing));
}

bool SlamEngine::isHeld(const Matrix6& ofScan) const {
  const Pose T_across(
      Eigen::Translation3d(m_scale.submapKeyframes * m_scale.keyframeDistance, 0, 0));
  const Matrix6 across = m_noise.information(T_across), both = (ofScan + across).inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(both.topLeftCorner<3, 3>());
  return 2 * axes.eigenvalues()[2] * across(0, 0) < 1;
}

bool SlamEngine::lossIsRare() const {
  constexpr std::size_t kAny = 3, kOneIn = 20;
  return m_scale.isPlanar && m_report.lost <= kAny + m_report.scans / kOneIn;
}

bool SlamEngine::isTorn() const { return !m_hasOdometry && m_lostInRow > kMostLost; }

bool SlamEngine::beginsKeyframe(const Pose& T_last_robot) const {
  if (!m_hasOdometry && m_lostInRow > 0) return isTorn();
  // If the robot was carried, what it sees now belongs to nothing that was seen before.
  if (m_lostInRow == 1 && lossIsRare()) return true;
  return wayOf(T_last_robot) >= m_scale.keyframeDistance ||
         turnOf(T_last_robot) >= m_scale.keyframeAngle;
}

Matrix6 SlamEngine::guessed(const Pose& T_step) const {
  return m_hasOdometry ? m_noise.information(T_step) : MotionNoise(true).information(T_step);
}

Slam::Added SlamEngine::beginFirst(const Seen& seen) {
  const auto found = findInReference(seen, seen.T_odometry_robot);
  m_report.referenced += found.has_value();
  const Pose T_map_robot = found ? found->T_submap_scan : seen.T_odometry_robot;
  m_T_odometry_last = seen.T_odometry_robot;
  begin(seen, T_map_robot, Pose::Identity());
  if (found) m_edges.push_back(lookOf(0, *found));
  return {0, Pose::Identity(), true, false};
}

void SlamEngine::begin(const Seen& seen, const Pose& T_map_robot, const Pose& T_last_keyframe) {
  keep(seen);
  m_T_keyframe_last = m_T_keyframe_found = Pose::Identity();
  if (isTorn()) m_lostInRow = 0;
  m_poses.push_back(levelled(T_map_robot, seen.T_odometry_robot));
  m_local.add(seen.cloud, T_last_keyframe, m_scale, m_options.useClasses);
}

void SlamEngine::keep(Seen seen) {
  const LabeledCloud& cloud = seen.cloud;
  const std::size_t n = cloud.size();
  std::uint64_t place = 0;
  if (m_file) {
    place = m_file->append(cloud.points.data(), n * sizeof(Eigen::Vector3f));
    m_file->append(cloud.classes.data(), n);
    seen.cloud = {};
  }
  m_keyframes.push_back({seen, m_report.way, m_lostWay, place, n});  // a copy has no room to grow
}

auto SlamEngine::seenAt(std::size_t keyframe) const -> Seen {
  const auto& [kept, way, lostWay, place, n] = m_keyframes[keyframe];
  Seen seen = kept;
  if (!m_file) return seen;
  seen.cloud.points.resize(n);
  seen.cloud.classes.resize(n);
  m_file->read(place, seen.cloud.points.data(), n * sizeof(Eigen::Vector3f));
  m_file->read(place + n * sizeof(Eigen::Vector3f), seen.cloud.classes.data(), n);
  return seen;
}

std::optional<Registration> SlamEngine::track(const Seen& seen, const Pose& T_step) {
  const std::size_t last = m_keyframes.size() - 1;
  const Matrix6 information = m_noise.information(T_step);
  const Pose T_guess = m_local.T_local_last() * m_T_keyframe_last * T_step;
  std::optional<Registration> r =
      match(m_local.submaps(), seen, T_guess, information / kOwnInformation);
  const Vector6 off = vectorOf(T_guess.inverse() * r->T_submap_scan);
  const bool isFar = isBeyond(off, information);
  const bool isFarForBadWheels = isBeyond(off, MotionNoise(!m_hasOdometry).information(T_step));
  // Beams in a plane fit but where they belong; in space much is ground, which fits anywhere.
  const bool mayBeFar = r->matchedShare >= kFitsWell && (m_scale.isPlanar || !isFarForBadWheels);
  if (isFar && r->matchedShare >= kFitsWell)
    m_noise.note(T_step, T_guess.inverse() * r->T_submap_scan,
                 kOwnInformation * r->information + information);
  const bool fits = isCovered(*r, seen) && r->matchedShare >= kFits;
  if (!fits || (isFar && !mayBeFar)) {
    auto found = searchAround(seen, T_guess, windowAround(T_step, information));
    // Nowhere else it fits better: wheels may err by more than they did so far.
    const bool stays = fits && m_hasOdometry && !m_scale.isPlanar && !isFarForBadWheels;
    if (found || !stays) r = std::move(found);
  }
  if (!r) return std::nullopt;
  r->information = kOwnInformation * r->information + information;
  const Pose T_map = m_poses[last] * m_local.T_local_last().inverse() * r->T_submap_scan;
  r->T_submap_scan = m_poses[last].inverse() * levelled(T_map, seen.T_odometry_robot);
  return r;
}

PlaneSearch::Window SlamEngine::windowAround(const Pose& T_step, const Matrix6& information) const {
  // Wheels that were good so far may slip.
  const Matrix6 first = MotionNoise(!m_hasOdometry).information(T_step);
  double way = kFar / std::sqrt(std::min(information(0, 0), first(0, 0))),
         turn = kFar / std::sqrt(std::min(information(5, 5), first(5, 5)));
  // It may have stopped, or its wheels stand while it goes on.
  if (!m_hasOdometry || m_T_odometry_step.isApprox(Pose::Identity())) {
    way += wayOf(goingOn());
    turn += turnOf(goingOn());
  }
  way *= 1 + m_lostInRow;
  turn *= 1 + m_lostInRow;
  return {std::clamp(way, 5 * m_scale.gridCell, 30 * m_scale.gridCell),
          std::clamp(turn, 5 * kDegree, (m_hasOdometry ? 45 : 90) * kDegree)};
}

bool SlamEngine::isCovered(const Registration& r, const Seen& seen) const {
  if (r.coveredShare >= kTracked) return true;
  // Few points may leave cubes empty that they are in, or alone in.
  const Registration itself =
      match(submapsOf(seen.cloud, {m_scale.cells.back()}), seen, Pose::Identity(), Matrix6::Zero());
  return r.coveredShare >= kTracked * itself.coveredShare;
}

std::optional<Registration> SlamEngine::searchAround(const Seen& seen, const Pose& T_local_guess,
                                                     const PlaneSearch::Window& window) const {
  PlanePoints points;
  const std::size_t first = m_keyframes.size() - m_local.poses().size();
  for (std::size_t k = first; k < m_keyframes.size(); ++k) {
    const Pose& T = m_local.poses()[k - first];
    for (const Eigen::Vector2d& p : upright(moved(seenAt(k).cloud, T))) points.push_back(p);
  }
  const Pose T_level = planar(T_local_guess).inverse() * T_local_guess;
  const PlaneSearch search(points, m_scale.gridCell);
  const PlanePoints searched = upright(moved(seen.cloud, T_level));
  // Wheels turn without moving the robot, or it is turned by hand: then it is nowhere else.
  for (const double angle : {window.angle, M_PI}) {
    const auto found =
        search.find(searched, flatOf(planar(T_local_guess)), {window.radius, angle}, kTrackedScore);
    if (!found || (angle > window.angle && !found->isAlone)) continue;
    const Registration r =
        match(m_local.submaps(), seen, poseOfFlat(found->pose) * T_level, Matrix6::Zero());
    if (isCovered(r, seen) && r.matchedShare >= kFitsWell) return r;
  }
  return std::nullopt;
}

void SlamEngine::learn(const Pose& T_step, const Registration& registered) {
  const Pose& T_registered = m_T_step;
  const Pose T_off = T_step.inverse() * T_registered;
  // In space chance says a little of the way along a corridor without an end: it would be learnt.
  if (m_scale.isPlanar) m_noise.calibrate(m_T_odometry_step, T_step, T_off, registered.information);
  m_noise.note(T_step, T_off, registered.information);
  const double way = wayOf(m_T_odometry_step);
  const auto ahead = T_registered.translation().dot(m_T_odometry_step.translation());
  m_wayOfOdometry += way;
  m_wayOfScans += way > 0 ? ahead / way : wayOf(T_registered);
  const double turn = vectorOf(T_registered)[5];
  if (std::abs(turn) < kSmall * m_scale.keyframeAngle) return;  // else noise would be summed up
  m_turnOfScans += std::abs(turn);
  m_turnOfOdometry += std::copysign(1.0, turn) * vectorOf(m_T_odometry_step)[5];
}

Matrix6 SlamEngine::levelOf(const Pose& T_odometry_robot) const {
  if (!isLevel()) return Matrix6::Zero();
  Matrix6 toLevel = Matrix6::Zero();
  toLevel.topLeftCorner<3, 3>() = toLevel.bottomRightCorner<3, 3>() =
      (planar(T_odometry_robot).inverse() * T_odometry_robot).linear();
  Vector6 known = Vector6::Zero();
  known.segment<3>(2).setConstant(kLevel);
  return toLevel.transpose() * known.asDiagonal() * toLevel;
}

Eigen::Isometry3d SlamEngine::levelled(const Pose& T_map_robot,
                                       const Pose& T_odometry_robot) const {
  if (!isLevel()) return T_map_robot;
  return rigid(planar(T_map_robot) * planar(T_odometry_robot).inverse() * T_odometry_robot);
}

Registration SlamEngine::match(const std::vector<Submap>& submaps, const Seen& seen,
                               const Pose& T_submap_guess, const Matrix6& prior) const {
  std::vector<const Submap*> pointers;
  for (const Submap& submap : submaps) pointers.push_back(&submap);
  const Matrix6 known = prior + levelOf(seen.T_odometry_robot);
  return registerScan(pointers, seen.cloud, T_submap_guess, known);
}

}  // namespace semantic_slam
