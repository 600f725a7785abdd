#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/ScanStream.h>
#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <strict_files/Words.h>

#include <chrono>
#include <stdexcept>

namespace labeled_cloud {

namespace fs = std::filesystem;
using mrpt::obs::CObservation;

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

const strict_files::Choices<ScanStreamOptions::OnProblem>& choicesOf(ScanStreamOptions::OnProblem) {
  using OnProblem = ScanStreamOptions::OnProblem;
  static const strict_files::Choices<OnProblem> choices = {{"stop", OnProblem::Stop},
                                                           {"skip", OnProblem::Skip}};
  return choices;
}

const strict_files::Choices<ScanStreamOptions::Unlabeled>& choicesOf(ScanStreamOptions::Unlabeled) {
  using Unlabeled = ScanStreamOptions::Unlabeled;
  static const strict_files::Choices<Unlabeled> choices = {{"occupancy", Unlabeled::Occupancy},
                                                           {"skip", Unlabeled::Skip}};
  return choices;
}

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
  result.name = m_rawlogs[m_file - 1].string() + ": observation " + std::to_string(waiting.number) +
                " (" + observation.GetRuntimeClass()->className + " '" + observation.sensorLabel +
                "')";
  result.bytesRead = m_bytesBefore + (m_reader ? m_reader->bytesRead() : 0);
  try {
    use(observation, result);
  } catch (const std::exception& e) {
    const std::string problem = result.name + ": " + strict_files::messageOf(e);
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
    throw std::invalid_argument("its time is " + std::to_string(back.count()) +
                                " s before that of this sensor's observation before it");
  last = observation.timestamp;
}

void ScanStream::use(const CObservation& observation, StreamedObservation& result) {
  if (m_labeler && isPicture(observation)) return checkOrder(observation);
  if (!ScanConverter::accepts(observation)) {
    result.holdsPose = saysWhereTheRobotIs(observation);
    result.skipped =
        std::string("of a kind without points: ") + observation.GetRuntimeClass()->className;
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
