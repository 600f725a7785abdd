#pragma once
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/core/Clock.h>
#include <mrpt/poses/CPose3D.h>
#include <strict_files/OptionList.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace labeled_cloud {

inline Eigen::Isometry3d toEigen(const mrpt::poses::CPose3D& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.matrix() = pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
  return T;
}

inline mrpt::poses::CPose3D toMrpt(const Eigen::Isometry3d& T) {
  return mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(T.matrix()));
}

/** A time in seconds since 1970, as data sets write it.
 * \throw std::invalid_argument it is not finite, or beyond what MRPT's clock can tell; of whole
 * milliseconds, microseconds or nanoseconds, that it looks like these. */
mrpt::Clock::time_point timeOfSeconds(double seconds);

struct TrajectoryOptions {
  /** How far outside the trajectory its first or last pose still holds, s. */
  double tolerance = 0.05;
  /** Poses farther apart in time are not interpolated between, s. */
  double maxGap = std::numeric_limits<double>::infinity();
};

/** Where the robot was: T_map_robot over time. */
class Trajectory {
 public:
  using Time = mrpt::Clock::time_point;

  explicit Trajectory(const TrajectoryOptions& options = {});

  /** Adds a pose; times may come in any order, the last pose of a time counts.
   * \throw std::invalid_argument the pose is not finite. */
  void insert(Time time, const mrpt::poses::CPose3D& T_map_robot);

  /** The pose at that time: an inserted one as it is, between two of them the position linearly and
   * the rotation along the shortest arc (SLERP). Nothing outside the trajectory or in a gap: beyond
   * `tolerance` of any pose. */
  std::optional<mrpt::poses::CPose3D> at(Time time) const;

  bool empty() const { return m_poses.empty(); }
  std::size_t size() const { return m_poses.size(); }
  const std::map<Time, mrpt::poses::CPose3D>& poses() const { return m_poses; }

 private:
  TrajectoryOptions m_options;
  std::map<Time, mrpt::poses::CPose3D> m_poses;
};

/** Reads a trajectory in the TUM RGB-D text format: `t tx ty tz qx qy qz qw` a line, seconds and
 * meters, '#' begins a comment.
 * \throw std::runtime_error naming file and line: unreadable, empty, a line that is not eight
 * numbers, a quaternion not of unit length (within 1 %), a time twice. */
Trajectory loadTumTrajectory(const std::filesystem::path& file,
                             const TrajectoryOptions& options = {});

/** All poses of some rawlogs that continue each other, in that order, from the best source that
 * they have; empty: there is none.
 *
 * 1. CObservationRobotPose: its `pose` is T_map_robot.
 * 2. Movements in action/sensory-frame rawlogs (2D or 3D), summed up from the origin; all
 *    observations of a sensory frame are taken from the pose after the movement before it.
 * 3. CObservationOdometry: absolute 2D odometry.
 *
 * \throw std::runtime_error as RawlogReader does, or naming the file: a pose is not finite. */
Trajectory findTrajectory(const std::vector<std::filesystem::path>& rawlogs);
/** findTrajectory(). \throw std::runtime_error also if there are no poses: naming the file, what
 * would have been taken, and the remedy. */
Trajectory readTrajectory(const std::vector<std::filesystem::path>& rawlogs,
                          const std::string& remedy = "give a trajectory file");

/** What belongs to the time nearest to this one, no farther away than a tolerance. */
template <class Time, class Value, class Duration>
std::optional<Value> nearestIn(const std::map<Time, Value>& all, Time time, Duration tolerance) {
  std::optional<Value> best;
  const auto consider = [&](const auto& candidate) {
    const auto apart = candidate.first < time ? time - candidate.first : candidate.first - time;
    if (apart <= tolerance) tolerance = apart, best = candidate.second;
  };
  const auto after = all.lower_bound(time);
  if (after != all.end()) consider(*after);
  if (after != all.begin()) consider(*std::prev(after));
  return best;
}

}  // namespace labeled_cloud
