#pragma once
#include <RosMessages.h>
#include <dds/dds.h>

#include <cstdint>
#include <string>
#include <vector>

/** \file
 * ROS 2's messages as Cyclone DDS has them: structs of C. */

namespace ros2 {

/** A type of messages. */
struct Type {
  const dds_topic_descriptor_t& dds;  ///< DDS's description of it
  const char* hash;                   ///< ROS's, of its definition (REP 2016)
};
template <class Message>
Type typeOf();

#define ROS2_MESSAGE(package, type, hash)                       \
  using type = package##_msg_dds__##type##_;                    \
  template <>                                                   \
  inline Type typeOf<type>() {                                  \
    return {package##_msg_dds__##type##__desc, "RIHS01_" hash}; \
  }
ROS2_MESSAGE(std_msgs, Bool, "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9")
ROS2_MESSAGE(std_msgs, Empty, "20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312")
ROS2_MESSAGE(rosgraph_msgs, Clock,
             "692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564")
ROS2_MESSAGE(geometry_msgs, PoseStamped,
             "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8")
ROS2_MESSAGE(geometry_msgs, PoseWithCovarianceStamped,
             "26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e")
ROS2_MESSAGE(geometry_msgs, Twist,
             "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a")
ROS2_MESSAGE(tf2_msgs, TFMessage,
             "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087")
ROS2_MESSAGE(sensor_msgs, PointCloud2,
             "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5")
ROS2_MESSAGE(sensor_msgs, Image, "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47")
ROS2_MESSAGE(sensor_msgs, CameraInfo,
             "b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275")
ROS2_MESSAGE(sensor_msgs, LaserScan,
             "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828")
ROS2_MESSAGE(nav_msgs, Odometry, "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0")
ROS2_MESSAGE(nav_msgs, Path, "1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b")
ROS2_MESSAGE(nav_msgs, OccupancyGrid,
             "8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7")
ROS2_MESSAGE(map_msgs, OccupancyGridUpdate,
             "c4095b0be2e4363f8978a1570e0293ee093436f1e1c61d99b48502ac317025e8")
ROS2_MESSAGE(visualization_msgs, MarkerArray,
             "86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf")
ROS2_MESSAGE(octomap_msgs, Octomap,
             "9891a19a05b70ec20aa8f45db3f8300b9ab80afff32c61c549d25087da9625b0")
#undef ROS2_MESSAGE

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
inline Time timeOf(Stamp stamp) {
  constexpr Stamp kSecond = 1'000'000'000;
  const Stamp seconds = stamp / kSecond - (stamp % kSecond < 0);
  return {static_cast<std::int32_t>(seconds),
          static_cast<std::uint32_t>(stamp - seconds * kSecond)};
}

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
inline Header headerOf(Stamp stamp, const std::string& frame) {
  return {timeOf(stamp), textOf(frame)};
}

}  // namespace ros2
