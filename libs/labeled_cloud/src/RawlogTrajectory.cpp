#include <labeled_cloud/Trajectory.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <stdexcept>

namespace labeled_cloud {

using mrpt::obs::CObservation;
using mrpt::obs::CObservationOdometry;
using mrpt::obs::CObservationRobotPose;
using mrpt::poses::CPose3D;

RawlogTrajectory::RawlogTrajectory(const TrajectoryOptions& options)
    : m_robotPoses(options), m_movements(options), m_odometry(options) {}

void RawlogTrajectory::add(const RawlogEntry& entry) {
  if (entry.actions) move(*entry.actions);
  if (entry.isFrame) addFrame(entry.observations);
  for (const CObservation::Ptr& observation : entry.observations) {
    if (const auto pose = std::dynamic_pointer_cast<CObservationRobotPose>(observation))
      m_robotPoses.insert(pose->timestamp, pose->pose.mean);
    if (const auto odometry = std::dynamic_pointer_cast<CObservationOdometry>(observation))
      m_odometry.insert(odometry->timestamp, CPose3D(odometry->odometry));
  }
}

void RawlogTrajectory::move(const mrpt::obs::CActionCollection& actions) {
  CPose3D movement;
  if (!actions.getFirstMovementEstimationMean(movement)) return;
  m_T_map_robot = m_T_map_robot + movement;
  m_moved = true;
}

void RawlogTrajectory::addFrame(const std::vector<CObservation::Ptr>& observations) {
  for (const CObservation::Ptr& observation : observations)
    if (observation->timestamp != INVALID_TIMESTAMP)
      m_movements.insert(observation->timestamp, m_T_map_robot);
}

RawlogTrajectory::Source RawlogTrajectory::source() const {
  if (!m_robotPoses.empty()) return Source::RobotPoses;
  if (m_moved) return Source::Movements;
  return m_odometry.empty() ? Source::None : Source::Odometry;
}

const Trajectory& RawlogTrajectory::trajectory() const {
  switch (source()) {
    case Source::RobotPoses:
      return m_robotPoses;
    case Source::Movements:
      return m_movements;
    default:
      return m_odometry;
  }
}

namespace {

void addNaming(const std::filesystem::path& file, const RawlogEntry& entry, RawlogTrajectory& to) {
  try {
    to.add(entry);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(file.string() + ": " + e.what());
  }
}

}  // namespace

Trajectory findTrajectory(const std::vector<std::filesystem::path>& rawlogs,
                          const TrajectoryOptions& options) {
  RawlogTrajectory collected(options);
  for (const auto& file : rawlogs) {
    RawlogReader reader(file);
    while (const auto entry = reader.next()) addNaming(file, *entry, collected);
  }
  return collected.trajectory();
}

Trajectory readTrajectory(const std::vector<std::filesystem::path>& rawlogs,
                          const TrajectoryOptions& options) {
  Trajectory found = findTrajectory(rawlogs, options);
  if (found.empty())
    throw std::runtime_error(
        (rawlogs.empty() ? std::string("no rawlog") : rawlogs.front().string()) +
        ": no robot poses (CObservationRobotPose, movements, or "
        "CObservationOdometry); give a trajectory file");
  return found;
}

}  // namespace labeled_cloud
