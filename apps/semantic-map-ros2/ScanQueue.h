#pragma once
#include <semantic_slam/Slam.h>

#include <Eigen/Geometry>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>

#include "ros2/Messages.h"

namespace semantic_map_ros2 {

/** A scan that came, and is not read yet. */
struct WaitingScan {
  std::string topic, frame;
  ros2::Stamp stamp = 0;
  ros2::Stamp cameAt = 0;  ///< by the node's clock
  std::chrono::steady_clock::time_point came;
  std::size_t bytes = 0;
  Eigen::Isometry3d T_frame_points = Eigen::Isometry3d::Identity();
  std::function<bool()> isComplete;  ///< whether all is there that it may have; null: it is
  /** Where its sensor is on the robot is left open. \throw std::exception what is wrong with it */
  std::function<semantic_slam::SensorScan()> read;
};

/** Scans in the order of their stamps, put in by DDS's threads and taken by another one. */
class ScanQueue {
 public:
  explicit ScanQueue(std::size_t mostBytes) : m_mostBytes(mostBytes) {}

  /** \return how many scans had to go, as there was no room */
  std::size_t push(WaitingScan scan);
  /** Waits until something comes. */
  void wait(std::chrono::milliseconds atMost);
  /** Something else came that is worth looking at. */
  void wake();
  /** Takes the first scan that a function says yes to; it may not touch the queue. */
  std::optional<WaitingScan> take(const std::function<bool(const WaitingScan&)>& accepts);

 private:
  std::mutex m_mutex;
  std::condition_variable m_changed;
  bool m_isNew = false;
  std::list<WaitingScan> m_scans;
  std::size_t m_bytes = 0, m_mostBytes;
};

}  // namespace semantic_map_ros2
