#pragma once
#include <labeled_cloud/RawlogReader.h>
#include <labeled_cloud/Trajectory.h>

#include <filesystem>
#include <string>
#include <vector>

namespace labeled_cloud {

/** Collects the robot's poses from a rawlog's entries, from the best source that they hold:
 *
 * 1. CObservationRobotPose: its `pose` is T_map_robot.
 * 2. Movements in action/sensory-frame rawlogs (2D or 3D), summed up from the origin; all
 *    observations of a sensory frame are taken from the pose after the movement before it.
 * 3. CObservationOdometry: absolute 2D odometry. */
class RawlogTrajectory {
 public:
  enum class Source { None, RobotPoses, Movements, Odometry };

  explicit RawlogTrajectory(const TrajectoryOptions& options = {});

  /** Takes the poses of the next entry. \throw std::invalid_argument a pose is not finite. */
  void add(const RawlogEntry& entry);

  /** The best source met so far. */
  Source source() const;
  /** The trajectory of that source, empty if there is none. */
  const Trajectory& trajectory() const;

 private:
  void move(const mrpt::obs::CActionCollection& actions);
  void addFrame(const std::vector<mrpt::obs::CObservation::Ptr>& observations);

  Trajectory m_robotPoses, m_movements, m_odometry;
  mrpt::poses::CPose3D m_T_map_robot;
  bool m_moved = false;
};

/** Reads all poses of some rawlogs that continue each other, in that order; empty: there are none.
 * \throw std::runtime_error as RawlogReader does, or naming the file: a pose is not finite. */
Trajectory findTrajectory(const std::vector<std::filesystem::path>& rawlogs,
                          const TrajectoryOptions& options = {});
/** findTrajectory(). \throw std::runtime_error also if there are no poses: naming the file and what
 * would have been taken. */
Trajectory readTrajectory(const std::vector<std::filesystem::path>& rawlogs,
                          const TrajectoryOptions& options = {});

}  // namespace labeled_cloud
