#pragma once
#include "simulated_drive/DriveLoop.h"
#include "synthetic_rawlog/DriveLog.h"

namespace semantic_map_drive {

using namespace simulated_drive;

/** Writes what the robot saw, and its true poses, as a rawlog. */
class Recorder : public DriveObserver {
 public:
  /** \throw std::runtime_error the file cannot be written. */
  explicit Recorder(const std::filesystem::path& file) : m_log(file, false, 0, 0) {}

  void onSensed(const DriveLoop& loop, const std::vector<Observation>& seen) override {
    std::vector<mrpt::obs::CObservation::Ptr> originals;
    for (const Observation& o : seen) originals.push_back(o.original);
    m_log.write(mrpt::Clock::now(), loop.T_world_robot(), originals);
  }
  void onFinished(const DriveLoop&) override { m_log.finish(); }

 private:
  synthetic_rawlog::DriveLog m_log;
};

}  // namespace semantic_map_drive
