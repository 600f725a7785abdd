#include <semantic_slam/Slam.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace semantic_slam {
namespace {

constexpr double kDegree = M_PI / 180;
/** Of the information that a registration's points would have together, were each off by itself. */
constexpr double kOwnInformation = 0.5;
/** Standard deviations of what loops say: less certain than their points, for they may be wrong. */
constexpr double kLoopMeters = 0.03, kLoopAngle = 0.1 * kDegree;
/** Of submaps: those of before are where they seem to be, a loop's other end may be meters off. */
const std::vector<double> kCellsNearby = {2, 1}, kCellsOfLoops = {8, 4, 2, 1};
/** Registrations that say otherwise than odometry by more are wrong. */
constexpr double kFarOff = 0.3, kFarTurned = 2 * kDegree;
/** The same in standard deviations of odometry, if that is more. */
constexpr double kFar = 4;
/** Information (1/m^2, 1/rad^2) of a height and a tilt that are known. */
constexpr double kLevel = 1e12;
/** Of a keyframe's points, those where a loop's other end has some. */
constexpr double kLeastCovered = 0.3;
/** Of the points that are registered, m. */
constexpr double kRegisteredCube = 0.5;

/** Of two poses where odometry has one, with this information. */
bool isFar(const Eigen::Isometry3d& T_off, const Matrix6& information) {
  const Vector6 off = vectorOf(T_off);
  return off.head<3>().norm() > std::max(kFarOff, kFar / std::sqrt(information(0, 0))) ||
         off.tail<3>().norm() > std::max(kFarTurned, kFar / std::sqrt(information(5, 5)));
}

LabeledCloud moved(LabeledCloud cloud, const Eigen::Isometry3d& T) {
  for (Eigen::Vector3f& p : cloud.points) p = (T * p.cast<double>()).cast<float>();
  return cloud;
}

/** x, y and heading of a pose. */
Eigen::Isometry3d planar(const Eigen::Isometry3d& T) {
  Eigen::Isometry3d result(Eigen::Translation3d(T.translation().x(), T.translation().y(), 0));
  result.rotate(Eigen::AngleAxisd(std::atan2(T(1, 0), T(0, 0)), Eigen::Vector3d::UnitZ()));
  return result;
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

void Slam::setReference(const semantic_octree::SemanticOcTree& map) {
  if (!m_keyframes.empty()) throw std::logic_error("Slam: a reference, but scans were added");
  m_reference = Reference(map, kCellsOfLoops, m_options.useClasses);
  m_mostOfReference = informationOf(std::max(kLoopMeters, m_reference.deviation()), kLoopAngle);
}

auto Slam::add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_robot_sensor,
               const Eigen::Isometry3d& T_odometry_robot) -> Added {
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  m_isPlanar = m_isPlanar && isHorizontal(cloud, T_robot_sensor);
  if (m_keyframes.empty()) {
    Seen first = seen(cloud, T_robot_sensor, T_odometry_robot);
    const auto found = findInReference(first, T_odometry_robot);
    m_numReferenced += found.has_value();
    begin(std::move(first), found ? found->T_submap_scan : T_odometry_robot);
    return {0, identity, true, false};
  }
  const std::size_t last = m_keyframes.size() - 1;
  const Eigen::Isometry3d T_guess =
      m_T_keyframe_last * (m_T_odometry_last.inverse() * T_odometry_robot);
  const Vector6 motion = vectorOf(T_guess);
  const bool isNew = motion.head<3>().norm() >= m_options.keyframeDistance ||
                     motion.tail<3>().norm() >= m_options.keyframeAngle * kDegree;
  if (!isNew && !m_options.registerAll) return {last, T_guess};
  Seen now = seen(cloud, T_robot_sensor, T_odometry_robot);
  const auto registered = track(now, T_guess);
  const Eigen::Isometry3d T_last_robot = registered ? registered->T_submap_scan : T_guess;
  if (!isNew) {
    if (registered) moveOn(T_last_robot, T_odometry_robot);
    return {last, T_last_robot};
  }
  const double way = T_guess.translation().norm();
  m_edges.push_back({last, last + 1, T_last_robot,
                     registered ? registered->information : odometryInformation(way, T_guess)});
  if (!registered) ++m_numLost;
  begin(std::move(now), rigid(m_poses.back() * T_last_robot));
  m_keyframes.back().way = m_keyframes[last].way + way;
  const bool followed = followReference();
  return {last + 1, identity, true, closeLoop() || followed};
}

auto Slam::seen(const LabeledCloud& cloud, const Eigen::Isometry3d& T_robot_sensor,
                const Eigen::Isometry3d& T_odometry_robot) const -> Seen {
  Seen seen{moved(thinned(cloud, m_options.cubeSize, m_options.maxRange), T_robot_sensor),
            T_odometry_robot};
  if (!m_options.useClasses)
    std::fill(seen.cloud.classes.begin(), seen.cloud.classes.end(), semantic_types::kNoClass);
  return seen;
}

void Slam::begin(Seen seen, const Eigen::Isometry3d& T_map_robot) {
  moveOn(Eigen::Isometry3d::Identity(), seen.T_odometry_robot);
  m_poses.push_back(levelled(T_map_robot, seen.T_odometry_robot));
  std::vector<float> histogram = histogramOf(seen.cloud, m_options.maxRange);
  m_keyframes.push_back({std::move(seen), 0, std::move(histogram)});
  m_nearby.clear();
}

void Slam::moveOn(const Eigen::Isometry3d& T_keyframe_robot,
                  const Eigen::Isometry3d& T_odometry_robot) {
  m_T_keyframe_last = T_keyframe_robot;
  m_T_odometry_last = T_odometry_robot;
}

std::optional<Registration> Slam::track(const Seen& seen, const Eigen::Isometry3d& T_last_guess) {
  const std::size_t last = m_keyframes.size() - 1;
  const auto before = static_cast<std::size_t>(m_options.submapKeyframes) - 1;
  if (m_nearby.empty())
    m_nearby = submapsOf(last - std::min(last, before), last, last, kCellsNearby);
  const Eigen::Isometry3d T_step = m_T_odometry_last.inverse() * seen.T_odometry_robot;
  const Matrix6 information = odometryInformation(T_step.translation().norm(), T_step);
  Registration r = match(m_nearby, seen, T_last_guess, information / kOwnInformation);
  if (r.matchedShare < m_options.registrationShare ||
      isFar(T_last_guess.inverse() * r.T_submap_scan, information))
    return std::nullopt;
  r.information = kOwnInformation * r.information + information;
  const Eigen::Isometry3d T_map = m_poses[last] * r.T_submap_scan;
  r.T_submap_scan = m_poses[last].inverse() * levelled(T_map, seen.T_odometry_robot);
  return r;
}

Matrix6 Slam::odometryInformation(double way, const Eigen::Isometry3d& T_step) const {
  const double root = std::sqrt(way), turned = vectorOf(T_step).tail<3>().norm();
  return informationOf(
      0.01 + m_options.odometryShare * root,
      (0.1 + m_options.odometryAngle * root) * kDegree + m_options.odometryTurn * turned);
}

Eigen::Isometry3d Slam::levelled(const Eigen::Isometry3d& T_map_robot,
                                 const Eigen::Isometry3d& T_odometry_robot) const {
  if (!isLevel()) return T_map_robot;
  return rigid(planar(T_map_robot) * planar(T_odometry_robot).inverse() * T_odometry_robot);
}

std::vector<Submap> Slam::submapsOf(std::size_t first, std::size_t last, std::size_t frame,
                                    const std::vector<double>& cellSizes) const {
  std::vector<Submap> submaps;
  for (const double size : cellSizes) {
    submaps.emplace_back(size, m_options.useClasses, m_isPlanar);
    for (std::size_t k = first; k <= last; ++k)
      submaps.back().add(m_keyframes[k].seen.cloud, m_poses[frame].inverse() * m_poses[k]);
    submaps.back().finish();
  }
  return submaps;
}

Matrix6 Slam::levelOf(const Eigen::Isometry3d& T_odometry_robot) const {
  if (!isLevel()) return Matrix6::Zero();
  Matrix6 toLevel = Matrix6::Zero();
  toLevel.topLeftCorner<3, 3>() = toLevel.bottomRightCorner<3, 3>() =
      (planar(T_odometry_robot).inverse() * T_odometry_robot).linear();
  Vector6 known = Vector6::Zero();
  known.segment<3>(2).setConstant(kLevel);
  return toLevel.transpose() * known.asDiagonal() * toLevel;
}

Registration Slam::match(const std::vector<Submap>& submaps, const Seen& seen,
                         const Eigen::Isometry3d& T_submap_guess, const Matrix6& prior) const {
  std::vector<const Submap*> pointers;
  for (const Submap& submap : submaps) pointers.push_back(&submap);
  const Matrix6 known = prior + levelOf(seen.T_odometry_robot);
  // Of a plane there are but squares, few enough.
  if (m_isPlanar) return registerScan(pointers, seen.cloud, T_submap_guess, known);
  return registerScan(pointers, thinned(seen.cloud, kRegisteredCube, m_options.maxRange),
                      T_submap_guess, known);
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

bool Slam::agree(const PoseEdge& before, const PoseEdge& edge) const {
  const Eigen::Isometry3d T_step = m_poses[before.b].inverse() * m_poses[edge.b];
  const Eigen::Isometry3d T_map_by_before = m_poses[before.a] * before.T_a_b * T_step;
  const double way = m_keyframes[edge.b].way - m_keyframes[before.b].way;
  return !isFar(T_map_by_before.inverse() * m_poses[edge.a] * edge.T_a_b,
                odometryInformation(way, T_step));
}

bool Slam::confirm(std::optional<PoseEdge>& last, const PoseEdge& edge) {
  const auto before = std::exchange(last, edge);
  if (!before || !agree(*before, edge)) return false;
  m_edges.push_back(edge);
  optimize(m_poses, m_edges);
  for (std::size_t k = 0; k < m_poses.size(); ++k)
    m_poses[k] = levelled(m_poses[k], m_keyframes[k].seen.T_odometry_robot);
  return true;
}

bool Slam::fits(const Registration& r) const {
  return r.coveredShare >= kLeastCovered && r.matchedShare >= m_options.loopShare;
}

std::optional<Registration> Slam::findInReference(const Seen& seen,
                                                  const Eigen::Isometry3d& T_map_guess) {
  if (!m_reference.exists()) return std::nullopt;
  const auto& submaps =
      m_isPlanar ? m_reference.sliceAt(seen.cloud, T_map_guess) : m_reference.inSpace();
  const Registration r = match(submaps, seen, T_map_guess, Matrix6::Zero());
  return fits(r) ? std::make_optional(r) : std::nullopt;
}

bool Slam::followReference() {
  const std::size_t newest = m_keyframes.size() - 1;
  if (m_keyframes[newest].way < m_lastReferenced + m_options.loopEvery) return false;
  m_lastReferenced = m_keyframes[newest].way;
  const auto found = findInReference(m_keyframes[newest].seen, m_poses[newest]);
  if (!found) return false;
  const Matrix6 own = kOwnInformation * found->information;
  // Both errors together. The first pose stays, so an edge from it says where the other is.
  const Matrix6 information = m_mostOfReference * (m_mostOfReference + own).inverse() * own;
  const Eigen::Isometry3d T_first_robot = m_poses.front().inverse() * found->T_submap_scan;
  if (!confirm(m_lastFound, {0, newest, T_first_robot, information, true})) return false;
  ++m_numReferenced;
  return true;
}

bool Slam::closeLoop() {
  const std::size_t newest = m_keyframes.size() - 1, place = placeOfLoop();
  if (place == newest || m_keyframes[newest].way < m_lastLook + m_options.loopEvery) return false;
  m_lastLook = m_keyframes[newest].way;
  const auto beside = static_cast<std::size_t>(m_options.submapKeyframes / 2);
  const std::vector<Submap> submaps = submapsOf(
      place - std::min(place, beside), std::min(place + beside, newest - 1), place, kCellsOfLoops);
  const Registration r = match(submaps, m_keyframes[newest].seen,
                               m_poses[place].inverse() * m_poses[newest], Matrix6::Zero());
  if (!fits(r)) return false;
  const Matrix6 information = informationOf(kLoopMeters, kLoopAngle);
  if (!confirm(m_lastLoop, {place, newest, r.T_submap_scan, information, true})) return false;
  ++m_numLoops;
  return true;
}

}  // namespace semantic_slam
