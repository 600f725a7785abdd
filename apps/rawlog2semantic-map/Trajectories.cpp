#include "Trajectories.h"

#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <strict_files/TextFile.h>

#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

#include "poses/Poses.h"

namespace rawlog2semantic_map {

namespace fs = std::filesystem;
using labeled_cloud::Trajectory;
using strict_files::TextLine;

namespace {

/** What says where the robot is, or is a picture, is no scan. */
bool isScan(const mrpt::obs::CObservation& o) {
  return !IS_CLASS(o, mrpt::obs::CObservationRobotPose) &&
         !IS_CLASS(o, mrpt::obs::CObservationOdometry) &&
         !IS_CLASS(o, mrpt::obs::CObservationImage) && !IS_CLASS(o, mrpt::obs::CObservationIMU);
}

std::set<Trajectory::Time> timesOfScans(const std::vector<fs::path>& rawlogs) {
  std::set<Trajectory::Time> times;
  for (const fs::path& file : rawlogs) {
    labeled_cloud::RawlogReader reader(file);
    while (const auto entry = reader.next())
      for (const auto& observation : entry->observations)
        if (isScan(*observation)) times.insert(observation->timestamp);
  }
  return times;
}

bool hasMatrices(const std::vector<TextLine>& lines) {
  if (lines.empty()) return false;
  std::istringstream words(lines.front().text);
  int count = 0;
  for (std::string word; words >> word;) ++count;
  return count == 12;
}

/** KITTI's own poses are those of a camera, which looks along z. */
void checkForward(const std::vector<mrpt::poses::CPose3D>& poses, const fs::path& file) {
  mrpt::math::TPoint3D way;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const mrpt::poses::CPose3D step = poses[i] - poses[i - 1];
    way += mrpt::math::TPoint3D(step.x(), step.y(), step.z());
  }
  if (std::abs(way.z) > std::abs(way.x) + std::abs(way.y))
    throw std::runtime_error(
        file.string() +
        ": these are poses of a camera (they move along their z axes), expected those of the "
        "robot, with x forward; dataset2rawlog semantic-kitti turns KITTI's own");
}

}  // namespace

Trajectory restAtOrigin() {
  labeled_cloud::TrajectoryOptions always;
  always.tolerance = HUGE_VAL;
  Trajectory trajectory(always);
  trajectory.insert({}, {});
  return trajectory;
}

Trajectory loadTrajectory(const fs::path& file, const std::vector<fs::path>& rawlogs) {
  const std::vector<TextLine> lines = strict_files::readLines(file);
  if (!hasMatrices(lines)) return labeled_cloud::loadTumTrajectory(file);
  std::vector<mrpt::poses::CPose3D> read;
  for (const TextLine& line : lines)
    read.emplace_back(mrpt::math::CMatrixDouble44(poses::poseOfMatrix(line).matrix()));
  checkForward(read, file);
  const std::set<Trajectory::Time> times = timesOfScans(rawlogs);
  if (read.size() != times.size())
    throw std::runtime_error(file.string() + ": " + std::to_string(read.size()) + " poses for " +
                             std::to_string(times.size()) + " scans");
  Trajectory trajectory;
  auto time = times.begin();
  for (const mrpt::poses::CPose3D& pose : read) trajectory.insert(*time++, pose);
  return trajectory;
}

Trajectory ownTrajectory(const std::vector<fs::path>& rawlogs, bool isNeeded) {
  Trajectory found = labeled_cloud::findTrajectory(rawlogs);
  if (found.empty() && isNeeded)
    throw std::runtime_error(rawlogs.front().string() +
                             ": no robot poses (CObservationRobotPose, movements, or "
                             "CObservationOdometry); give --trajectory or --slam, or --static-pose "
                             "if the robot stood still");
  return found;
}

}  // namespace rawlog2semantic_map
