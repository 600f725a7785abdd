#pragma once
#include <labeled_cloud/CloudLabeler.h>
#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace labeled_cloud {

struct ScanStreamOptions {
  /** What to do about observations that cannot be used: stop with an error, or leave them out. */
  enum class OnProblem { Stop, Skip };
  OnProblem onProblem = OnProblem::Stop;
  /** What becomes of scans of which no point has a class: they count for occupancy, or are left
   * out. */
  enum class Unlabeled { Occupancy, Skip };
  Unlabeled unlabeled = Unlabeled::Occupancy;
  /** Every N-th scan comes with the pictures that its labels are from. 0: none does. */
  std::size_t picturesEvery = 0;

  void describe(strict_files::OptionList& list);
};
inline strict_files::Choices<ScanStreamOptions::OnProblem> choicesOf(ScanStreamOptions::OnProblem) {
  return {{"stop", ScanStreamOptions::OnProblem::Stop},
          {"skip", ScanStreamOptions::OnProblem::Skip}};
}
inline strict_files::Choices<ScanStreamOptions::Unlabeled> choicesOf(ScanStreamOptions::Unlabeled) {
  return {{"occupancy", ScanStreamOptions::Unlabeled::Occupancy},
          {"skip", ScanStreamOptions::Unlabeled::Skip}};
}

/** What became of one observation of a rawlog. */
struct StreamedObservation {
  /** File, number, class and sensor, for messages. */
  std::string name;
  /** The scan, or nothing: the observation was skipped, or is a picture. */
  std::optional<LabeledScan> scan;
  mrpt::poses::CPose3D T_map_robot;
  /** Why it was skipped; empty for scans and pictures. */
  std::string skipped;
  /** Whether it says where the robot is: of use for a trajectory, if no scan. */
  bool holdsPose = false;
  /** What was wrong, with this observation or with a picture of its time; it is in the text. */
  std::vector<std::string> problems;
  /** How long making and labeling the scan took, ms. */
  double milliseconds = 0;
  /** Bytes read of all rawlogs up to here. */
  std::uint64_t bytesRead = 0;
};

/** The scans of some rawlogs that continue each other, ready for a map, in the rawlogs' order.
 *
 * Scans without labels wait until the pictures around their time were read. No more than a few
 * seconds of a rawlog are in memory. Pictures and scans of different rawlogs do not meet. */
class ScanStream {
 public:
  /** Converter, trajectory and labeler must outlive the stream.
   * \param labeler Of scans without labels; may be null. */
  ScanStream(std::vector<std::filesystem::path> rawlogs, ScanConverter& converter,
             const Trajectory& trajectory, CloudLabeler* labeler,
             const ScanStreamOptions& options = {});

  /** The next observation, or nothing at the end.
   * \throw std::runtime_error naming the file: it is damaged; or (OnProblem::Stop) the observation
   * and why it cannot be used. */
  std::optional<StreamedObservation> next();

 private:
  /** An observation that was read, and how often observations were read before it. */
  struct Waiting {
    mrpt::obs::CObservation::Ptr observation;
    std::size_t number;
  };

  bool open();
  void read();
  bool isReady(const mrpt::obs::CObservation& observation) const;
  bool needsPictures(const mrpt::obs::CObservation& observation) const;
  StreamedObservation take(const Waiting& waiting);
  void use(const mrpt::obs::CObservation& observation, StreamedObservation& result);
  void convert(const mrpt::obs::CObservation& observation, StreamedObservation& result);
  void checkOrder(const mrpt::obs::CObservation& observation);

  std::vector<std::filesystem::path> m_rawlogs;
  ScanConverter& m_converter;
  const Trajectory& m_trajectory;
  CloudLabeler* m_labeler;
  ScanStreamOptions m_options;

  std::size_t m_file = 0;  ///< of the rawlogs, behind the one that is open
  std::unique_ptr<RawlogReader> m_reader;
  std::deque<Waiting> m_waiting;
  std::size_t m_numRead = 0, m_scans = 0;
  std::uint64_t m_bytesBefore = 0;
  Trajectory::Time m_newest;
  std::map<std::string, Trajectory::Time> m_lastOfSensor;
};

}  // namespace labeled_cloud
