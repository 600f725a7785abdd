#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "TemporaryFolder.h"
#include "ros2/Node.h"

/** A number of a DDS domain that no other process on this machine has, as long as this lives. */
class DomainOfItsOwn {
 public:
  /** Sets ROS_DOMAIN_ID, and that nothing leaves this machine. */
  DomainOfItsOwn();
  ~DomainOfItsOwn();

 private:
  int m_lock;
};

/** The exit status of a program that was asked to stop by Ctrl-C. */
constexpr int kStopped = 130;

/** semantic-map-ros2 as a process, and a node that speaks to it. */
class LiveMap {
 public:
  /** Waits until it hears. \param parameters behind --ros-args \param beside whose domain it is in;
   * null: one of its own */
  explicit LiveMap(const std::vector<std::string>& parameters,
                   const std::vector<std::string>& arguments = {}, const LiveMap* beside = nullptr);
  ~LiveMap();

  ros2::Node& node() { return *m_node; }
  /** What it has said until now. */
  std::string said() const { return folder.read("said"); }
  /** Waits for as long as a busy machine may take. \return whether it came true */
  bool waitFor(const std::function<bool()>& condition) const;
  /** Waits until it has inserted so many scans. */
  bool waitForScans(std::size_t scans) const;
  /** Ends it as Ctrl-C does. \return its exit status */
  int end();
  bool isRunning() const;
  /** What it wrote. */
  semantic_octree::SemanticOcTree map() const;

  /** The transform from one frame to another, to /tf or /tf_static. */
  void place(const std::string& parent, const std::string& child, const Eigen::Isometry3d& T,
             ros2::Stamp stamp, bool isStatic = false);
  /** Writes as soon as the program hears it. */
  template <class Message>
  void send(ros2::Publication<Message>& to, const Message& message) {
    waitFor([&] { return to.isRead(); });
    to.write(message);
  }

  TemporaryFolder folder;

 private:
  std::optional<DomainOfItsOwn> m_domain;
  int m_process = -1;
  std::unique_ptr<ros2::Node> m_node;
  std::unique_ptr<ros2::Publication<ros2::TFMessage>> m_transforms, m_static;
  std::vector<ros2::TransformStamped> m_staticTransforms;
  std::vector<std::unique_ptr<std::string>> m_frames;
};

/** The last message of a topic. */
template <class Message>
class Heard {
 public:
  Heard(LiveMap& live, const std::string& topic, const ros2::Qos& qos = {true, false, 100})
      : m_hears(live.node(), topic, qos, [this](auto message) {
          const std::lock_guard<std::mutex> lock(m_mutex);
          m_all.push_back(message);
        }) {}
  std::shared_ptr<const Message> last() const {
    const std::lock_guard<std::mutex> lock(m_mutex);
    return m_all.empty() ? nullptr : m_all.back();
  }
  std::vector<std::shared_ptr<const Message>> all() const {
    const std::lock_guard<std::mutex> lock(m_mutex);
    return m_all;
  }

 private:
  mutable std::mutex m_mutex;
  std::vector<std::shared_ptr<const Message>> m_all;
  ros2::Subscription<Message> m_hears;
};

/** Points as a sensor of ROS sends them: x, y, z, and a byte of class ids. */
class PointMessage {
 public:
  PointMessage(const semantic_types::LabeledCloud& cloud, const std::string& frame,
               ros2::Stamp stamp, const std::string& classField = "label");
  const ros2::PointCloud2& message() const { return m_message; }
  ros2::PointCloud2& message() { return m_message; }

 private:
  std::string m_frame;
  std::vector<std::string> m_names;
  std::vector<ros2::PointField> m_fields;
  std::vector<std::uint8_t> m_data;
  ros2::PointCloud2 m_message{};
};
