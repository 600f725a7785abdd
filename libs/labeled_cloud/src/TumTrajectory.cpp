#include <labeled_cloud/Trajectory.h>
#include <mrpt/poses/CPose3DQuat.h>
#include <strict_files/TextFile.h>

#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace labeled_cloud {

namespace {

/** `t tx ty tz qx qy qz qw`. \throw std::runtime_error the line is something else. */
std::array<double, 8> parseLine(const std::string& line) {
  std::istringstream stream(line);
  const strict_files::ClassicNumbers classic(stream);
  std::array<double, 8> values;
  for (double& value : values)
    if (!(stream >> value) || !std::isfinite(value))
      throw std::runtime_error("expected 't tx ty tz qx qy qz qw', found '" + line + "'");
  std::string rest;
  if (stream >> rest) throw std::runtime_error("more than eight values: '" + line + "'");
  return values;
}

mrpt::poses::CPose3D poseOf(const std::array<double, 8>& v) {
  const double norm = std::sqrt(v[4] * v[4] + v[5] * v[5] + v[6] * v[6] + v[7] * v[7]);
  if (std::abs(norm - 1) > 0.01)
    throw std::runtime_error("the quaternion's length is " + std::to_string(norm) + ", not 1");
  const mrpt::math::CQuaternionDouble q(v[7] / norm, v[4] / norm, v[5] / norm, v[6] / norm);
  return mrpt::poses::CPose3D(mrpt::poses::CPose3DQuat(v[1], v[2], v[3], q));
}

void insertLine(Trajectory& trajectory, const std::string& line) {
  const auto values = parseLine(line);
  const auto time = timeOfSeconds(values[0]);
  if (trajectory.poses().count(time)) throw std::runtime_error("this time was there before");
  trajectory.insert(time, poseOf(values));
}

}  // namespace

Trajectory loadTumTrajectory(const std::filesystem::path& file, const TrajectoryOptions& options) {
  Trajectory trajectory(options);
  for (const strict_files::TextLine& line : strict_files::readLines(file)) {
    try {
      insertLine(trajectory, line.text);
    } catch (const std::exception& e) {
      throw std::runtime_error(line.where + ": " + e.what());
    }
  }
  if (trajectory.empty()) throw std::runtime_error(file.string() + ": no pose in this trajectory");
  return trajectory;
}

}  // namespace labeled_cloud
