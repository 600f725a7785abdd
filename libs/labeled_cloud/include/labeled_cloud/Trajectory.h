#pragma once
#include <mrpt/core/Clock.h>
#include <mrpt/poses/CPose3D.h>
#include <strict_files/OptionList.h>

#include <filesystem>
#include <limits>
#include <map>
#include <optional>

namespace labeled_cloud {

struct TrajectoryOptions {
  /** How far outside the trajectory its first or last pose still holds, s. */
  double tolerance = 0.05;
  /** Poses farther apart in time are not interpolated between, s. */
  double maxGap = std::numeric_limits<double>::infinity();

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
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
 * \throw std::runtime_error naming file and line: unreadable or empty file, a line that is not
 * eight numbers, a quaternion that is not of unit length (within 1 %), a time that comes twice. */
Trajectory loadTumTrajectory(const std::filesystem::path& file,
                             const TrajectoryOptions& options = {});

}  // namespace labeled_cloud
