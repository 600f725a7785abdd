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

#include "Parameters.h"
#include "point_fields/Frames.h"

namespace semantic_map_ros2 {

using point_fields::Stamp;

/** A scan that came, and is not read yet. */
struct WaitingScan {
  std::string topic, frame;
  Stamp stamp = 0;
  std::size_t bytes = 0;
  Eigen::Isometry3d T_frame_points = Eigen::Isometry3d::Identity();
  std::function<bool()> isComplete;  ///< whether all is there that it may have; null: it is
  /** Where its sensor is on the robot is left open. \throw std::exception what is wrong with it */
  std::function<semantic_slam::SensorScan()> read;
  Stamp cameAt = 0;  ///< by the node's clock
  std::chrono::steady_clock::time_point came;
};

/** What a node knows, whatever middleware it speaks. */
struct Surroundings {
  using Answer = point_fields::Frames::Answer;
  std::function<Answer(const std::string& target, const std::string& source, Stamp stamp)> find;
  std::function<Stamp()> now;
  std::function<void(const std::string& what)> complain;
};

/** Scans in the order of their stamps, put in by the middleware's threads. They are taken by
 * another one when it is known where they were seen, and left out when they waited for too long. */
class ScanQueue {
 public:
  /** \param options must outlive it */
  ScanQueue(const NodeOptions& options, Surroundings surroundings)
      : m_options(options), m_surroundings(std::move(surroundings)) {}

  /** If there is no room, the oldest go. */
  void push(WaitingScan scan);
  /** Waits until something comes. */
  void wait(std::chrono::milliseconds atMost);
  /** Something else came that is worth looking at. */
  void wake();
  /** What comes from now on does not count. */
  void close();

  using Insert = std::function<void(const WaitingScan& scan, semantic_slam::SensorScan seen,
                                    const Eigen::Isometry3d& T_world_robot)>;
  /** Takes the first scan that can be inserted, or waited for long enough.
   * \return whether there was one */
  bool insertNext(const Insert& insert);
  std::size_t leftOut() const { return m_leftOut; }

 private:
  struct Place {
    std::optional<Eigen::Isometry3d> T_world_robot, T_robot_points;
    std::string problem;  ///< why one of them is not known
    bool isLost = false;  ///< and will not be
  };
  Place placeOf(const WaitingScan& scan) const;
  bool isDue(const WaitingScan& scan) const;

  const NodeOptions& m_options;
  Surroundings m_surroundings;
  std::mutex m_mutex;
  std::condition_variable m_changed;
  bool m_isNew = false, m_isClosed = false;
  std::list<WaitingScan> m_scans;
  std::size_t m_bytes = 0, m_leftOut = 0;
};

}  // namespace semantic_map_ros2
