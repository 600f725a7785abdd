#pragma once
#include <RosMessages.h>
#include <dds/dds.h>

#include <cstdint>
#include <string>
#include <vector>

/** \file
 * ROS 2's messages as Cyclone DDS has them: structs of C. */

namespace ros2 {

/** DDS's description of a message. */
template <class Message>
const dds_topic_descriptor_t& descriptorOf();

#define ROS2_MESSAGE(package, type)                           \
  using type = package##_msg_dds__##type##_;                  \
  template <>                                                 \
  inline const dds_topic_descriptor_t& descriptorOf<type>() { \
    return package##_msg_dds__##type##__desc;                 \
  }
ROS2_MESSAGE(std_msgs, Bool)
ROS2_MESSAGE(std_msgs, Empty)
ROS2_MESSAGE(rosgraph_msgs, Clock)
ROS2_MESSAGE(geometry_msgs, PoseStamped)
ROS2_MESSAGE(geometry_msgs, PoseWithCovarianceStamped)
ROS2_MESSAGE(geometry_msgs, Twist)
ROS2_MESSAGE(tf2_msgs, TFMessage)
ROS2_MESSAGE(sensor_msgs, PointCloud2)
ROS2_MESSAGE(sensor_msgs, Image)
ROS2_MESSAGE(sensor_msgs, CameraInfo)
ROS2_MESSAGE(sensor_msgs, LaserScan)
ROS2_MESSAGE(nav_msgs, Odometry)
ROS2_MESSAGE(nav_msgs, Path)
ROS2_MESSAGE(nav_msgs, OccupancyGrid)
ROS2_MESSAGE(map_msgs, OccupancyGridUpdate)
ROS2_MESSAGE(visualization_msgs, MarkerArray)
ROS2_MESSAGE(octomap_msgs, Octomap)
#undef ROS2_MESSAGE

/** ROS's hash of a message's definition (REP 2016), by DDS's description of it. */
std::string typeHashOf(const dds_topic_descriptor_t& type);

using Header = std_msgs_msg_dds__Header_;
using Time = builtin_interfaces_msg_dds__Time_;
using TransformStamped = geometry_msgs_msg_dds__TransformStamped_;
using PointField = sensor_msgs_msg_dds__PointField_;
using Marker = visualization_msgs_msg_dds__Marker_;
using Point = geometry_msgs_msg_dds__Point_;

/** Nanoseconds since 1970, or of a simulation. */
using Stamp = std::int64_t;
inline Stamp stampOf(const Time& time) { return Stamp(time.sec) * 1'000'000'000 + time.nanosec; }
inline double secondsOf(Stamp stamp) { return static_cast<double>(stamp) * 1e-9; }
Time timeOf(Stamp stamp);

/** Texts of messages that are received may be null. */
inline std::string textOf(const char* text) { return text ? text : ""; }
/** A message's text: the string must live until the message is written. */
inline char* textOf(const std::string& text) { return const_cast<char*>(text.c_str()); }

/** A message's sequence: the elements must live until the message is written. */
template <class Sequence, class Element>
void refer(Sequence& sequence, const std::vector<Element>& elements) {
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(elements.size());
  sequence._buffer = const_cast<Element*>(elements.data());
  sequence._release = false;
}

/** A header whose frame must live until the message is written. */
Header headerOf(Stamp stamp, const std::string& frame);

}  // namespace ros2
