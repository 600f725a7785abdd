#include "VillageFrames.h"

#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

mrpt::maps::CSimpleMap villageFrames(std::size_t count) {
  labeled_cloud::RawlogReader rawlog(std::string(MSO_SOURCE_DIR) +
                                     "/rawlog-samples/village.rawlog");
  mrpt::maps::CSimpleMap frames;
  mrpt::obs::CSensoryFrame::Ptr frame;
  while (const auto entry = rawlog.next())
    for (const auto& observation : entry->observations) {
      const auto pose = std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(observation);
      if (!pose) {
        frame->insert(observation);
        continue;
      }
      if (frames.size() == count) return frames;
      frame = mrpt::obs::CSensoryFrame::Create();
      frames.insert(mrpt::poses::CPose3DPDFGaussian::Create(pose->pose), frame);
    }
  return frames;
}
