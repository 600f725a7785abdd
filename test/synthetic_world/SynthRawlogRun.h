#pragma once
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <string>

#include "RunProgram.h"
#include "TemporaryFolder.h"

/** Runs of the program synth-rawlog, and what they leave behind. */
namespace synth_rawlog_run {

namespace fs = std::filesystem;

using Folder = TemporaryFolder;

inline ProgramRun run(const Folder& folder, const std::string& arguments) {
  return runCommand("cd '" + folder.path().string() + "' && '" MSO_BIN_DIR "/synth-rawlog' " +
                    arguments);
}

/** All observations of a rawlog, those of sensory frames too, in their order. */
inline std::vector<mrpt::obs::CObservation::Ptr> observationsOf(const fs::path& rawlog) {
  labeled_cloud::registerObservations();
  std::vector<mrpt::obs::CObservation::Ptr> all;
  labeled_cloud::RawlogReader reader(rawlog);
  while (const auto entry = reader.next())
    all.insert(all.end(), entry->observations.begin(), entry->observations.end());
  return all;
}

template <class T>
std::vector<typename T::Ptr> only(const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
  std::vector<typename T::Ptr> result;
  for (const auto& o : observations)
    if (const auto t = std::dynamic_pointer_cast<T>(o)) result.push_back(t);
  return result;
}

/** The label bits of a pixel: bit i is class i. */
inline std::uint32_t labelBits(const mrpt::obs::CObservation3DRangeScan& scan, int row,
                               int column) {
  return dynamic_cast<const mrpt::obs::TPixelLabelInfo<4>&>(*scan.pixelLabels)
      .pixelLabels(row, column);
}

}  // namespace synth_rawlog_run
