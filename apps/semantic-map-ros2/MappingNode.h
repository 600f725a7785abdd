#pragma once
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_slam/Mapper.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "Driving.h"
#include "MapMessages.h"
#include "Sensors.h"
#include "Terminal.h"

namespace semantic_map_ros2 {

/** The last message of a topic, for whoever looks for it now and then. */
template <class Message>
class Inbox {
 public:
  Inbox(ros2::Node& node, const std::string& topic)
      : m_hears(node, topic, {true, false, 1}, [this](std::shared_ptr<const Message> message) {
          std::atomic_store(&m_message, std::move(message));
        }) {}
  /** Null: nothing came since. */
  std::shared_ptr<const Message> take() { return std::atomic_exchange(&m_message, {}); }

 private:
  std::shared_ptr<const Message> m_message;
  ros2::Subscription<Message> m_hears;
};

/** The node: what sensors say goes into a map, and what is known is published. One thread, that of
 * run(), works on the map; DDS's threads fill queues. */
class MappingNode {
 public:
  /** \param map must outlive it \param save is called when somebody asks for it (`~/save`) */
  MappingNode(const Parameters& parameters, const ros2::Arguments& arguments,
              semantic_octree::SemanticOcTree& map, std::function<void()> save);

  /** Until it is to stop; then the robot stands, and what waits is inserted. */
  void run(const StopRequest& stop);
  std::size_t scans() const { return m_scans; }
  /** What became of scans, and how long it took. */
  void saySummary() const;

 private:
  bool insertNext();
  void insert(const WaitingScan& scan, semantic_slam::SensorScan seen,
              const Eigen::Isometry3d& T_world_robot);
  std::optional<semantic_navigation::RobotState> robotAt(ros2::Stamp stamp) const;
  void hear();
  void serve();
  void look();
  void publish();
  void publishCorrection();
  void onExploring(bool isToExplore);
  void onGoal(const ros2::PoseStamped& message);
  void onInitialPose(const ros2::PoseWithCovarianceStamped& message);
  std::optional<Eigen::Isometry3d> inMap(const ros2::Header& header,
                                         const geometry_msgs_msg_dds__Pose_& pose,
                                         const std::string& what);

  Parameters m_parameters;
  ros2::Node m_node;
  Complaints m_complaints;
  NodeClock m_clock;
  point_fields::Frames m_frames{true};
  ScanQueue m_queue;
  semantic_slam::Mapper m_mapper;
  MapMessages m_messages;
  TreeMessages m_tree;
  std::optional<Driving> m_driving;  ///< with an order
  std::optional<GroundGrid> m_grid;  ///< with an order
  ros2::Publication<ros2::TFMessage> m_writesTransforms;
  std::function<void()> m_save;

  semantic_map::ObservationClock m_scanClock;
  double m_seconds = 0;  ///< that passed, by the scans
  std::size_t m_scans = 0;
  ros2::Stamp m_stamp = 0;                           ///< of the last scan
  std::optional<Eigen::Isometry3d> m_T_world_robot;  ///< then
  bool m_isNew = false;                              ///< the map has what was not published
  std::vector<std::chrono::steady_clock::time_point> m_came;  ///< of scans not published
  std::vector<double> m_latencies;                            ///< ms, of the last scans
  std::chrono::steady_clock::time_point m_publishedAt, m_steppedAt, m_lookedAt;
  std::optional<ros2::Stamp> m_correctedAt;

  Sensors m_sensors;
  Inbox<ros2::PoseStamped> m_goals;
  Inbox<ros2::PoseWithCovarianceStamped> m_initialPoses;
  Inbox<ros2::Bool> m_explorings;
  Inbox<ros2::Empty> m_saves;
};

}  // namespace semantic_map_ros2
