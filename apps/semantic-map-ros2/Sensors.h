#pragma once
#include <labeled_cloud/ScanConverter.h>

#include <atomic>
#include <memory>
#include <mutex>

#include "Complaints.h"
#include "Parameters.h"
#include "ScanQueue.h"
#include "WaitingLabels.h"
#include "point_fields/Frames.h"
#include "ros2/Node.h"

namespace semantic_map_ros2 {

/** Time: the machine's, or what /clock says. */
class NodeClock {
 public:
  /** \param simulated the machine's time does not count */
  explicit NodeClock(bool simulated) : m_simulated(simulated) {}
  ros2::Stamp now() const;
  void set(ros2::Stamp now) { m_now = now; }

 private:
  bool m_simulated;
  std::atomic<ros2::Stamp> m_now{0};
};

/** How the robot moves, by its odometry: m/s, rad/s. */
struct Speeds {
  double forward = 0, turn = 0;
};

/** What the node hears of sensors and of where they are. Clouds, scans and depth images go into a
 * queue; they are read when they are taken from it. */
class Sensors {
 public:
  /** All must outlive it. */
  Sensors(ros2::Node& node, const NodeOptions& options, const semantic_types::ClassTable& classes,
          const labeled_cloud::ScanConverterOptions& conversion, NodeClock& clock,
          point_fields::Frames& frames, ScanQueue& queue, Complaints& complaints);
  ~Sensors();

  Speeds speeds() const;

 private:
  class PixelLabels;
  /** Puts a scan into the queue. */
  template <class Message>
  void add(const ros2::Subscription<Message>& from, std::shared_ptr<const Message> message,
           std::size_t bytes);
  void addLabels(std::shared_ptr<const ros2::Image> message);
  template <class Message, class Vector, class Rotation>
  void add(const Message& message, const Vector& translation, const Rotation& rotation,
           point_fields::Frames::Kind kind);
  void addTransforms(const ros2::TFMessage& message, point_fields::Frames::Kind kind);
  bool hasLabels(ros2::Stamp stamp) const;
  semantic_slam::SensorScan read(const ros2::PointCloud2& message);
  semantic_slam::SensorScan read(const ros2::LaserScan& message);
  semantic_slam::SensorScan read(const ros2::Image& depth);

  const NodeOptions& m_options;
  semantic_types::ClassTable m_classes;
  NodeClock& m_clock;
  point_fields::Frames& m_frames;
  ScanQueue& m_queue;
  Complaints& m_complaints;
  std::shared_ptr<PixelLabels> m_labeler;
  labeled_cloud::ScanConverter m_converter;

  mutable std::mutex m_mutex;
  WaitingLabels m_labels;
  std::shared_ptr<const ros2::CameraInfo> m_camera;
  Speeds m_speeds;
  ros2::Subscription<ros2::Clock> m_hearsClock;
  ros2::Subscription<ros2::TFMessage> m_hearsTransforms, m_hearsStatic;
  ros2::Subscription<ros2::Odometry> m_hearsOdometry;
  ros2::Subscription<ros2::PointCloud2> m_hearsPoints;
  ros2::Subscription<ros2::LaserScan> m_hearsLaser;
  ros2::Subscription<ros2::CameraInfo> m_hearsCamera;
  ros2::Subscription<ros2::Image> m_hearsLabels, m_hearsDepth;
};

}  // namespace semantic_map_ros2
