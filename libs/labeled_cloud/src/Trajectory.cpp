#include <labeled_cloud/Trajectory.h>

#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/ScanStream.h>
#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/poses/CPose3DQuat.h>
#include <strict_files/OptionList.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <sstream>

#include "PointLabels.h"

namespace labeled_cloud {

using mrpt::obs::CObservation;
using mrpt::obs::CObservationOdometry;
using mrpt::obs::CObservationRobotPose;
using mrpt::poses::CPose3D;
using mrpt::poses::CPose3DQuat;

mrpt::Clock::time_point timeOfSeconds(double seconds) {
  constexpr double kMost = 2e11;  // years: 6000; the clock has 64 bits of 100 ns
  constexpr double kIn1980 = 315532800, kYear = 365.25 * 86400;
  if (std::abs(seconds) <= kMost) return mrpt::Clock::fromDouble(seconds);
  std::string why = strict_files::textOf(seconds) + " s is no time";
  for (const auto& [unit, factor] :
       {std::pair("nano", 1e9), std::pair("micro", 1e6), std::pair("milli", 1e3)})
    if (const double years = (seconds / factor - kIn1980) / kYear; years > 0 && years < 100)
      why += std::string("; it looks like ") + unit + "seconds: divide by " +
             strict_files::textOf(factor);
  throw std::invalid_argument(why);
}

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

Trajectory::Trajectory(const TrajectoryOptions& options) : m_options(options) {}

void Trajectory::insert(Time time, const CPose3D& T_map_robot) {
  for (int i = 0; i < 6; ++i)
    if (!std::isfinite(T_map_robot[i]))
      throw std::invalid_argument("trajectory: the pose at " +
                                  strict_files::textOf(mrpt::Clock::toDouble(time)) +
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
    throw std::runtime_error("the quaternion's length is " + strict_files::textOf(norm) +
                             ", not 1");
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

namespace {

/** Where a rawlog's entries have the robot, by source. */
struct Sources {
  Trajectory robotPoses, movements, odometry;
  CPose3D T_map_robot;
  bool hasMoved = false;

  void add(const RawlogEntry& entry) {
    CPose3D movement;
    if (entry.actions && entry.actions->getFirstMovementEstimationMean(movement)) {
      T_map_robot = T_map_robot + movement;
      hasMoved = true;
    }
    for (const CObservation::Ptr& observation : entry.observations) {
      if (entry.isFrame && observation->timestamp != INVALID_TIMESTAMP)
        movements.insert(observation->timestamp, T_map_robot);
      if (const auto pose = std::dynamic_pointer_cast<CObservationRobotPose>(observation))
        robotPoses.insert(pose->timestamp, pose->pose.mean);
      if (const auto odometer = std::dynamic_pointer_cast<CObservationOdometry>(observation))
        odometry.insert(odometer->timestamp, CPose3D(odometer->odometry));
    }
  }
};

}  // namespace

Trajectory findTrajectory(const std::vector<std::filesystem::path>& rawlogs) {
  Sources sources;
  for (const auto& file : rawlogs) {
    RawlogReader reader(file);
    while (const auto entry = reader.next()) try {
        sources.add(*entry);
      } catch (const std::invalid_argument& e) {
        throw std::runtime_error(file.string() + ": " + e.what());
      }
  }
  if (!sources.robotPoses.empty()) return sources.robotPoses;
  return sources.hasMoved ? sources.movements : sources.odometry;
}

Trajectory readTrajectory(const std::vector<std::filesystem::path>& rawlogs,
                          const std::string& remedy) {
  Trajectory found = findTrajectory(rawlogs);
  if (found.empty())
    throw std::runtime_error(
        (rawlogs.empty() ? std::string("no rawlog") : rawlogs.front().string()) +
        ": no robot poses (CObservationRobotPose, movements, or CObservationOdometry); " + remedy);
  return found;
}

namespace fs = std::filesystem;

namespace {

/** More observations than this do not wait for pictures. */
constexpr std::size_t kMostWaiting = 256;

/** Where the images are that a rawlog holds only the names of. */
fs::path imagesFolder(const fs::path& rawlog) {
  return fs::absolute(rawlog).parent_path() / (rawlog.stem().string() + "_Images");
}

bool saysWhereTheRobotIs(const CObservation& observation) {
  return dynamic_cast<const mrpt::obs::CObservationRobotPose*>(&observation) ||
         dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation);
}

double millisecondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

}  // namespace

void ScanStreamOptions::describe(strict_files::OptionList& list) {
  list.add("on_problem", onProblem, "", "what to do about an observation that cannot be used");
  list.add("unlabeled", unlabeled, "",
           "what becomes of a scan without any label: it counts for occupancy, or is left out");
}

ScanStream::ScanStream(std::vector<fs::path> rawlogs, ScanConverter& converter,
                       const Trajectory& trajectory, CloudLabeler* labeler,
                       const ScanStreamOptions& options)
    : m_rawlogs(std::move(rawlogs)),
      m_converter(converter),
      m_trajectory(trajectory),
      m_labeler(labeler),
      m_options(options) {}

bool ScanStream::open() {
  if (m_file > 0) m_bytesBefore += fs::file_size(m_rawlogs[m_file - 1]);
  if (m_file == m_rawlogs.size()) return false;
  m_reader = std::make_unique<RawlogReader>(m_rawlogs[m_file]);
  mrpt::img::CImage::setImagesPathBase(imagesFolder(m_rawlogs[m_file]).string());
  m_numRead = 0;
  m_newest = {};
  m_lastOfSensor.clear();
  ++m_file;
  return true;
}

void ScanStream::read() {
  const auto entry = m_reader->next();
  if (!entry) return m_reader.reset();
  for (const CObservation::Ptr& observation : entry->observations) {
    m_waiting.push_back({observation, ++m_numRead});
    m_newest = std::max(m_newest, observation->timestamp);
    if (m_labeler && isPicture(*observation)) m_labeler->addPicture(observation);
  }
}

std::optional<StreamedObservation> ScanStream::next() {
  while (true) {
    if (!m_waiting.empty() && (!m_reader || isReady(*m_waiting.front().observation))) {
      const Waiting first = std::move(m_waiting.front());
      m_waiting.pop_front();
      return take(first);
    }
    if (m_reader)
      read();
    else if (!open())
      return std::nullopt;
  }
}

bool ScanStream::needsPictures(const CObservation& observation) const {
  if (!m_labeler || !ScanConverter::accepts(observation)) return false;
  if (const auto* cloud = dynamic_cast<const CObservationLabeledCloud*>(&observation))
    return cloud->cloud.classes.empty() && cloud->cloud.probabilities.empty();
  return !dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation);
}

bool ScanStream::isReady(const CObservation& observation) const {
  if (!needsPictures(observation) || m_waiting.size() > kMostWaiting) return true;
  const auto time = observation.timestamp;
  const std::chrono::duration<double> passed = m_newest - time;
  return m_labeler->sawAllCamerasAt(time) || passed.count() > m_labeler->options().tolerance;
}

StreamedObservation ScanStream::take(const Waiting& waiting) {
  const CObservation& observation = *waiting.observation;
  StreamedObservation result;
  const std::string place =
      m_rawlogs[m_file - 1].string() + ": observation " + std::to_string(waiting.number);
  result.name = place + " (" + kindOf(observation) + " '" + observation.sensorLabel + "')";
  result.bytesRead = m_bytesBefore + (m_reader ? m_reader->bytesRead() : 0);
  try {
    use(observation, result);
  } catch (const std::exception& e) {
    const std::string said = strict_files::messageOf(e), own = nameOf(observation);
    const bool namesIt = said.rfind(own + ": ", 0) == 0;
    const std::string problem =
        namesIt ? place + " (" + own + ")" + said.substr(own.size()) : result.name + ": " + said;
    if (m_options.onProblem == ScanStreamOptions::OnProblem::Stop)
      throw std::runtime_error(problem);
    result.scan.reset();
    result.skipped = "unusable";
    result.problems.push_back(problem);
  }
  return result;
}

void ScanStream::checkOrder(const CObservation& observation) {
  auto& last = m_lastOfSensor[observation.sensorLabel];
  const std::chrono::duration<double> back = last - observation.timestamp;
  if (back.count() > 0)
    throw std::invalid_argument("its time is " + strict_files::textOf(back.count()) +
                                " s before that of this sensor's observation before it");
  last = observation.timestamp;
}

void ScanStream::use(const CObservation& observation, StreamedObservation& result) {
  if (m_labeler && isPicture(observation)) return checkOrder(observation);
  if (!ScanConverter::accepts(observation)) {
    result.holdsPose = saysWhereTheRobotIs(observation);
    result.skipped = "of a kind without points: " + kindOf(observation);
    return;
  }
  checkOrder(observation);
  const auto T_map_robot = m_trajectory.at(observation.timestamp);
  if (!T_map_robot) {
    result.skipped = "outside the trajectory";
    return;
  }
  result.T_map_robot = *T_map_robot;
  convert(observation, result);
}

void ScanStream::convert(const CObservation& observation, StreamedObservation& result) {
  const auto begin = std::chrono::steady_clock::now();
  const bool keepPictures = m_options.picturesEvery > 0 && m_scans % m_options.picturesEvery == 0;
  m_converter.keepPictures(keepPictures);
  LabeledScan scan = *m_converter.convert(observation);
  if (needsPictures(observation)) {
    m_labeler->forgetBefore(observation.timestamp);
    m_labeler->label(scan, result.T_map_robot, keepPictures);
    result.problems = m_labeler->takeProblems();
  }
  result.milliseconds = millisecondsSince(begin);
  if (scan.cloud.empty())
    result.skipped = "without a point of usable range";
  else if (scan.counts.labeled == 0 && m_options.unlabeled == ScanStreamOptions::Unlabeled::Skip)
    result.skipped = "without labels";
  else
    result.scan = std::move(scan), ++m_scans;
}

}  // namespace labeled_cloud
