#include <semantic_slam/Mapper.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace semantic_slam {

using semantic_octree::InsertionReport;
using semantic_octree::KeyframeMap;
using semantic_octree::SemanticOcTree;

namespace {

/** So many beams turn a voxel from surely occupied to surely free (the other way takes fewer), so
 * earlier looks matter no more. */
std::size_t scansThatDecide(const semantic_octree::FilterParameters& p) {
  const auto logOdds = [](double q) { return std::log(q / (1 - q)); };
  const double whole = logOdds(p.maxProbability) - logOdds(p.minOccupancy);
  const double passes = std::log((1 - p.falseAlarmProbability) / (1 - p.hitProbability));
  const double hits = std::log(p.hitProbability / p.falseAlarmProbability);
  return static_cast<std::size_t>(std::ceil(whole / std::min(passes, hits)));
}

}  // namespace

Mapper::Mapper(SemanticOcTree& map, const MapperOptions& options, const SemanticOcTree* reference)
    : m_map(map),
      m_options(options),
      m_forgetAt(options.forgetsFrom),
      m_calibrator(map.getResolution(), map.numClasses()) {
  m_options.insertion.validate();
  if (!m_options.localize) return;
  m_slam.emplace(m_options.slam, m_options.scans);
  if (!map.empty() && !reference) reference = &map;
  if (reference) m_slam->setReference(*reference);
  if (!map.empty()) return;
  m_keyframes = m_options.scans.empty() ? std::make_unique<KeyframeMap>(map)
                                        : std::make_unique<KeyframeMap>(map, m_options.scans);
}

auto Mapper::locate(const std::vector<SensorScan>& seen,
                    const std::optional<Eigen::Isometry3d>& T_odometry_robot, double seconds)
    -> Place {
  if (!m_slam && !T_odometry_robot)
    throw std::invalid_argument("Mapper: scans without a pose of odometry need localize");
  if (!m_slam) {
    const double passed = m_last ? seconds - m_last->second : 0;
    if (passed >= kLeastTimeOfVelocity)
      m_velocity = velocityOf(m_last->first.inverse() * *T_odometry_robot, passed);
    if (!m_last || passed < 0 || passed >= kLeastTimeOfVelocity)
      m_last = {*T_odometry_robot, seconds};
    return {*T_odometry_robot, {}, m_velocity};
  }
  std::optional<Eigen::Isometry3d> T_start_robot;
  if (T_odometry_robot) T_start_robot = m_T_start_odometry * *T_odometry_robot;
  const Slam::Added added = addToSlam(seen, T_start_robot, seconds);
  const Eigen::Isometry3d T_map_robot = m_slam->poses().back() * added.T_keyframe_robot;
  if (T_odometry_robot) m_T_map_odometry = T_map_robot * T_odometry_robot->inverse();
  return {T_map_robot, added, added.velocity};
}

void Mapper::relocalize(const Eigen::Isometry3d& T_map_odometry) {
  if (!m_slam) throw std::logic_error("Mapper: to relocalize needs localize");
  m_T_map_odometry = m_T_start_odometry = T_map_odometry;
  if (m_slam->poses().empty()) return;
  finish();
  m_keyframes = nullptr;
  m_slam.emplace(m_options.slam, m_options.scans);
  m_slam->setReference(m_map);
}

Slam::Added Mapper::addToSlam(const std::vector<SensorScan>& seen,
                              const std::optional<Eigen::Isometry3d>& T_odometry_robot,
                              double seconds) {
  if (seen.size() == 1 && m_isMover.empty() && !std::isfinite(seen[0].emptyFrom))
    return m_slam->add(seen[0], T_odometry_robot, seconds);
  return m_slam->add(evidenceOf(seen), T_odometry_robot, seconds);
}

/** Returns of what does not move, frame of the robot. */
SensorScan Mapper::evidenceOf(const std::vector<SensorScan>& seen) const {
  const bool haveTimes = std::any_of(seen.begin(), seen.end(),
                                     [](const SensorScan& scan) { return !scan.times.empty(); });
  SensorScan evidence;
  LabeledCloud& cloud = evidence.cloud;
  for (const SensorScan& scan : seen)
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      const auto id = scan.cloud.classes.empty() ? semantic_types::kNoClass : scan.cloud.classes[i];
      if (id < m_isMover.size() && m_isMover[id]) continue;
      if (scan.cloud.points[i].norm() >= scan.emptyFrom) continue;
      cloud.points.push_back(
          (scan.T_robot_sensor * scan.cloud.points[i].cast<double>()).cast<float>());
      cloud.classes.push_back(id);
      if (haveTimes) evidence.times.push_back(scan.times.empty() ? 0 : scan.times.at(i));
    }
  return evidence;
}

bool Mapper::isLeftOut(const Place& place) {
  if (!place.added || place.added->isNew || ++m_leftOut >= m_options.insertEvery) m_leftOut = 0;
  return m_leftOut > 0;
}

auto Mapper::insert(const std::vector<SensorScan>& seen, const Place& place, double seconds)
    -> Inserted {
  constexpr double kOff = 0.25;  // voxels: keyframes that are off by more are moved
  Inserted inserted{place, {}};
  if (m_keyframes && place.added->isNew)
    m_ids.push_back(m_keyframes->begin(m_slam->poses().back()));
  if (!isLeftOut(place))
    for (const SensorScan& scan : seen) {
      const SensorScan straight =
          scan.times.empty() ? SensorScan() : deskewed(scan, place.velocity);
      const LabeledCloud& cloud = (scan.times.empty() ? scan : straight).cloud;
      semantic_octree::InsertionOptions options = m_options.insertion;
      if (std::isfinite(scan.emptyFrom) &&
          !(options.maxRange > 0 && options.maxRange < scan.emptyFrom))
        options.maxRange = scan.emptyFrom;
      inserted.scans.push_back(
          insertAt(place, cloud, scan.T_robot_sensor, options, secondsUntil(seconds)));
      m_agedAt = std::max(seconds, m_agedAt.value_or(seconds));
      m_calibrator.add(cloud, place.T_map_robot * scan.T_robot_sensor, options);
      if (++m_numScans < m_calibrateAt) continue;
      calibrate();
      m_calibrateAt *= 2;
    }
  if (m_keyframes && place.added->posesMoved) moveKeyframes(kOff * m_map.getResolution());
  if (m_slam && m_slam->poses().size() >= m_forgetAt) forget();
  return inserted;
}

InsertionReport Mapper::insertAt(const Place& place, const LabeledCloud& cloud,
                                 const Eigen::Isometry3d& T_robot_cloud,
                                 const semantic_octree::InsertionOptions& options,
                                 double secondsSince) {
  if (!place.added)
    return m_map.insert(cloud, place.T_map_robot * T_robot_cloud, options, secondsSince);
  const Eigen::Isometry3d T_keyframe_cloud = place.added->T_keyframe_robot * T_robot_cloud;
  if (m_keyframes) return m_keyframes->insert(cloud, T_keyframe_cloud, options, secondsSince);
  return m_map.insert(cloud, m_slam->poses().back() * T_keyframe_cloud, options, secondsSince);
}

void Mapper::insertBelow(const LabeledCloud& points, const Place& place) {
  semantic_octree::InsertionOptions noRays;
  noRays.carvingMargin = 1e3;
  insertAt(place, points, Eigen::Isometry3d::Identity(), noRays, 0);
}

/** Beams in all directions that end beyond. */
void Mapper::insertFree(const Eigen::Vector3d& p, double radius, const Place& place) {
  const double golden = M_PI * (3 - std::sqrt(5.0));
  const double apart = m_map.getResolution() / 2;
  const int beams = static_cast<int>(std::ceil(4 * M_PI * radius * radius / (apart * apart)));
  LabeledCloud cloud;
  for (int i = 0; i < beams; ++i) {
    const double z = 1 - (2 * i + 1.0) / beams, r = std::sqrt(1 - z * z);
    const Eigen::Vector3d direction(r * std::cos(golden * i), r * std::sin(golden * i), z);
    cloud.points.push_back((2 * radius * direction).cast<float>());
  }
  semantic_octree::InsertionOptions upTo;
  upTo.maxRange = radius;
  insertAt(place, cloud, Eigen::Isometry3d(Eigen::Translation3d(p)), upTo, 0);
}

double Mapper::secondsUntil(double seconds) const {
  constexpr double kMost = 1e9;  // what a map may age by; a clock that is set leaps by more
  return m_agedAt ? std::min(kMost, std::max(0.0, seconds - *m_agedAt)) : 0;
}

void Mapper::age(double seconds) {
  m_map.age(secondsUntil(seconds));
  m_agedAt = std::max(seconds, m_agedAt.value_or(seconds));
}

void Mapper::finish() {
  calibrate();
  if (m_slam) m_slam->finish();
  if (m_keyframes) moveKeyframes(-1);
  stateCalibrated();
}

void Mapper::calibrate() {
  stateCalibrated();
  m_calibration = std::async(std::launch::async | std::launch::deferred,  // where no thread is left
                             m_calibrator.fitLater(m_map));
}

void Mapper::stateCalibrated() {
  if (m_calibration.valid()) m_map.setCalibration(m_calibration.get());
}

/** Moves keyframes whose points 10 m away are off by more than this; below 0: all keyframes. */
void Mapper::moveKeyframes(double meters) {
  constexpr double kSeenFrom = 10;  // m
  std::vector<semantic_octree::KeyframePose> off;
  for (std::size_t k = 0; k < m_slam->poses().size(); ++k) {
    const Eigen::Isometry3d& T_map_keyframe = m_slam->poses()[k];
    const Vector6 by = vectorOf(m_keyframes->pose(m_ids[k]).inverse() * T_map_keyframe);
    if (by.head<3>().norm() + kSeenFrom * by.tail<3>().norm() > meters)
      off.push_back({m_ids[k], T_map_keyframe});
  }
  if (off.empty()) return;
  calibrate();
  m_calibrator.clear();
  m_keyframes->move(off);
}

/** When there are twice as many as were left: so each scan is merged once more, in the mean. */
void Mapper::forget() {
  const auto many = m_slam->outnumbered(scansThatDecide(m_map.filterParameters()));
  if (m_keyframes) {
    std::set<semantic_octree::KeyframeId> ids;
    for (const std::size_t k : many) ids.insert(m_ids[k]);
    calibrate();
    m_calibrator.clear();
    m_keyframes->remove(ids);
    m_ids.erase(std::remove_if(m_ids.begin(), m_ids.end(),
                               [&](const auto id) { return ids.count(id) > 0; }),
                m_ids.end());
  }
  m_slam->forget(many);
  m_forgetAt = std::max(m_options.forgetsFrom, 2 * m_slam->poses().size());
}

}  // namespace semantic_slam
