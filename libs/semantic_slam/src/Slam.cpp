#include <semantic_slam/Slam.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace semantic_slam {
namespace {

constexpr double kDegree = M_PI / 180;
/** Standard deviations of what registrations say. */
constexpr double kRegistrationMeters = 0.01, kRegistrationAngle = 0.03 * kDegree;
constexpr double kLoopMeters = 0.03, kLoopAngle = 0.1 * kDegree;
/** Of submaps: those of before are where they seem to be, a loop's other end may be meters off. */
const std::vector<double> kCellsNearby = {2, 1}, kCellsOfLoops = {8, 4, 2, 1};
/** Registrations that say otherwise than odometry by more are wrong. */
constexpr double kFarOff = 0.3, kFarTurned = 2 * kDegree;
/** Of a keyframe's points where there are some of before. */
constexpr double kLeastCovered = 0.3;
/** Of the points that are registered, m. */
constexpr double kRegisteredCube = 0.5;

LabeledCloud moved(LabeledCloud cloud, const Eigen::Isometry3d& T) {
  for (Eigen::Vector3f& p : cloud.points) p = (T * p.cast<double>()).cast<float>();
  return cloud;
}

/** Shares of classes in rings around the robot: the same from wherever it looks. */
std::vector<float> histogramOf(const LabeledCloud& cloud, double maxRange) {
  constexpr int kRings = 5, kClasses = 256;
  std::vector<float> histogram(kRings * kClasses, 0.f);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double share = cloud.points[i].head<2>().norm() / maxRange;
    const int ring = std::min(kRings - 1, static_cast<int>(share * kRings));
    histogram[ring * kClasses + cloud.classes[i]] += 1.f / static_cast<float>(cloud.size());
  }
  return histogram;
}

/** 0 nothing in common, 1 the same. */
double likeness(const std::vector<float>& a, const std::vector<float>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0, std::plus<>(),
                            [](float x, float y) { return std::min(x, y); });
}

}  // namespace

Slam::Slam(const SlamOptions& options) : m_options(options) { m_options.validate(); }

auto Slam::add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_robot_sensor,
               const Eigen::Isometry3d& T_odometry_robot) -> Added {
  if (!m_keyframes.empty()) {
    const Eigen::Isometry3d T = m_keyframes.back().T_odometry_keyframe.inverse() * T_odometry_robot;
    const Vector6 motion = vectorOf(T);
    if (motion.head<3>().norm() < m_options.keyframeDistance &&
        motion.tail<3>().norm() < m_options.keyframeAngle * kDegree)
      return {m_keyframes.size() - 1, T};
  }
  begin(cloud, T_robot_sensor, T_odometry_robot);
  connect();
  return {m_keyframes.size() - 1, Eigen::Isometry3d::Identity(), true, closeLoop()};
}

void Slam::begin(const LabeledCloud& cloud, const Eigen::Isometry3d& T_robot_sensor,
                 const Eigen::Isometry3d& T_odometry_robot) {
  Keyframe k{T_odometry_robot, 0, {}, {}};
  k.cloud = moved(thinned(cloud, m_options.cubeSize, m_options.maxRange), T_robot_sensor);
  if (!m_options.useClasses)
    std::fill(k.cloud.classes.begin(), k.cloud.classes.end(), semantic_types::kNoClass);
  k.histogram = histogramOf(k.cloud, m_options.maxRange);
  Eigen::Isometry3d T_map = T_odometry_robot;
  if (!m_keyframes.empty()) {
    const Keyframe& last = m_keyframes.back();
    const Eigen::Isometry3d T = last.T_odometry_keyframe.inverse() * T_odometry_robot;
    k.way = last.way + T.translation().norm();
    T_map = rigid(m_poses.back() * T);
  }
  m_keyframes.push_back(std::move(k));
  m_poses.push_back(T_map);
}

void Slam::connect() {
  const std::size_t newest = m_keyframes.size() - 1;
  if (newest == 0) return;
  const std::size_t last = newest - 1;
  const Eigen::Isometry3d T_odometry = m_poses[last].inverse() * m_poses[newest];
  const double way = m_keyframes[newest].way - m_keyframes[last].way;
  m_edges.push_back({last, newest, T_odometry,
                     informationOf(0.01 + m_options.odometryShare * way,
                                   (0.1 + m_options.odometryAngle * way) * kDegree)});
  const auto before = static_cast<std::size_t>(m_options.submapKeyframes);
  const Registration r = match(newest - std::min(newest, before), last, last, kCellsNearby);
  const Vector6 off = vectorOf(T_odometry.inverse() * r.T_submap_scan);
  if (r.coveredShare < kLeastCovered || r.matchedShare < m_options.registrationShare ||
      off.head<3>().norm() > kFarOff || off.tail<3>().norm() > kFarTurned)
    return void(++m_numLost);
  m_edges.push_back(
      {last, newest, r.T_submap_scan, informationOf(kRegistrationMeters, kRegistrationAngle)});
  m_poses[newest] = rigid(m_poses[last] * r.T_submap_scan);
}

Registration Slam::match(std::size_t first, std::size_t last, std::size_t frame,
                         const std::vector<double>& cellSizes) const {
  std::vector<Submap> submaps;
  for (const double size : cellSizes) {
    submaps.emplace_back(size, m_options.useClasses);
    for (std::size_t k = first; k <= last; ++k)
      submaps.back().add(m_keyframes[k].cloud, m_poses[frame].inverse() * m_poses[k]);
    submaps.back().finish();
  }
  std::vector<const Submap*> pointers;
  for (const Submap& submap : submaps) pointers.push_back(&submap);
  const LabeledCloud scan = thinned(m_keyframes.back().cloud, kRegisteredCube, m_options.maxRange);
  return registerScan(pointers, scan, m_poses[frame].inverse() * m_poses.back());
}

std::size_t Slam::placeOfLoop() const {
  const Keyframe& here = m_keyframes.back();
  std::size_t best = m_keyframes.size() - 1;
  double highest = 0;
  for (std::size_t k = 0; k < m_keyframes.size(); ++k) {
    const double between = here.way - m_keyframes[k].way;
    if (between < m_options.loopLength) break;
    const double radius = m_options.loopRadius + m_options.loopDrift * between;
    if ((m_poses[k].translation() - m_poses.back().translation()).norm() > radius) continue;
    const double like = likeness(here.histogram, m_keyframes[k].histogram);
    if (like <= highest) continue;
    highest = like;
    best = k;
  }
  return best;
}

bool Slam::closeLoop() {
  const std::size_t newest = m_keyframes.size() - 1, place = placeOfLoop();
  if (place == newest || m_keyframes[newest].way < m_lastLook + m_options.loopEvery) return false;
  m_lastLook = m_keyframes[newest].way;
  const auto beside = static_cast<std::size_t>(m_options.submapKeyframes / 2);
  const Registration r = match(place - std::min(place, beside),
                               std::min(place + beside, newest - 1), place, kCellsOfLoops);
  if (r.coveredShare < kLeastCovered || r.matchedShare < m_options.loopShare) return false;
  m_edges.push_back({place, newest, r.T_submap_scan, informationOf(kLoopMeters, kLoopAngle), true});
  optimize(m_poses, m_edges);
  ++m_numLoops;
  return true;
}

std::vector<semantic_octree::KeyframePose> posesOf(const Slam& slam) {
  std::vector<semantic_octree::KeyframePose> poses;
  for (const Eigen::Isometry3d& T : slam.poses()) poses.push_back({poses.size(), T});
  return poses;
}

}  // namespace semantic_slam
