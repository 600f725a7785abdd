#include <labeled_cloud/Trajectory.h>
#include <mrpt/poses/CPose3DQuat.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

namespace labeled_cloud {

using mrpt::poses::CPose3D;
using mrpt::poses::CPose3DQuat;

namespace {

double seconds(mrpt::Clock::duration d) { return std::chrono::duration<double>(d).count(); }

Eigen::Quaterniond rotationOf(const CPose3D& pose) {
  const CPose3DQuat q(pose);
  return {q.quat().r(), q.quat().x(), q.quat().y(), q.quat().z()};
}

CPose3D interpolate(const CPose3D& a, const CPose3D& b, double fraction) {
  const auto along = [&](double from, double to) { return from + fraction * (to - from); };
  const Eigen::Quaterniond q = rotationOf(a).slerp(fraction, rotationOf(b)).normalized();
  return CPose3D(CPose3DQuat(along(a.x(), b.x()), along(a.y(), b.y()), along(a.z(), b.z()),
                             mrpt::math::CQuaternionDouble(q.w(), q.x(), q.y(), q.z())));
}

}  // namespace

void TrajectoryOptions::describe(strict_files::OptionList& list) {
  using strict_files::above;
  using strict_files::atLeast;
  list.add("tolerance", tolerance, "s", atLeast(0).orInfinite(),
           "how far outside the trajectory its first or last pose still holds");
  list.add("max_gap", maxGap, "s", above(0).orInfinite(),
           "poses farther apart are not interpolated between");
}

void TrajectoryOptions::validate() const { strict_files::checkOptions(*this, "TrajectoryOptions"); }

Trajectory::Trajectory(const TrajectoryOptions& options) : m_options(options) {
  m_options.validate();
}

void Trajectory::insert(Time time, const CPose3D& T_map_robot) {
  for (int i = 0; i < 6; ++i)
    if (!std::isfinite(T_map_robot[i]))
      throw std::invalid_argument("trajectory: the pose at " +
                                  std::to_string(mrpt::Clock::toDouble(time)) +
                                  " s is not finite: " + T_map_robot.asString());
  m_poses[time] = T_map_robot;
}

std::optional<CPose3D> Trajectory::at(Time time) const {
  const auto after = m_poses.lower_bound(time);
  if (after != m_poses.end() && after->first == time) return after->second;

  const bool hasAfter = after != m_poses.end(), hasBefore = after != m_poses.begin();
  const auto before = hasBefore ? std::prev(after) : after;
  if (hasAfter && hasBefore) {
    const double gap = seconds(after->first - before->first);
    if (gap <= m_options.maxGap)
      return interpolate(before->second, after->second, seconds(time - before->first) / gap);
  }
  if (hasBefore && seconds(time - before->first) <= m_options.tolerance) return before->second;
  if (hasAfter && seconds(after->first - time) <= m_options.tolerance) return after->second;
  return std::nullopt;
}

}  // namespace labeled_cloud
