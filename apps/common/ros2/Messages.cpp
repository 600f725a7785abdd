#include "ros2/Messages.h"

#include <map>

namespace ros2 {

Time timeOf(Stamp stamp) {
  constexpr Stamp kSecond = 1'000'000'000;
  const Stamp seconds = stamp / kSecond - (stamp % kSecond < 0);
  return {static_cast<std::int32_t>(seconds),
          static_cast<std::uint32_t>(stamp - seconds * kSecond)};
}

Header headerOf(Stamp stamp, const std::string& frame) { return {timeOf(stamp), textOf(frame)}; }

std::string typeHashOf(const dds_topic_descriptor_t& type) {
  static const std::map<std::string, std::string> kHashes = {
      {"std_msgs::msg::dds_::Bool_",
       "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9"},
      {"std_msgs::msg::dds_::Empty_",
       "20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312"},
      {"rosgraph_msgs::msg::dds_::Clock_",
       "692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564"},
      {"geometry_msgs::msg::dds_::PoseStamped_",
       "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8"},
      {"geometry_msgs::msg::dds_::PoseWithCovarianceStamped_",
       "26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e"},
      {"geometry_msgs::msg::dds_::Twist_",
       "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a"},
      {"tf2_msgs::msg::dds_::TFMessage_",
       "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
      {"sensor_msgs::msg::dds_::PointCloud2_",
       "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"},
      {"sensor_msgs::msg::dds_::Image_",
       "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47"},
      {"sensor_msgs::msg::dds_::CameraInfo_",
       "b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275"},
      {"sensor_msgs::msg::dds_::LaserScan_",
       "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828"},
      {"nav_msgs::msg::dds_::Odometry_",
       "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"},
      {"nav_msgs::msg::dds_::Path_",
       "1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b"},
      {"nav_msgs::msg::dds_::OccupancyGrid_",
       "8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7"},
      {"map_msgs::msg::dds_::OccupancyGridUpdate_",
       "c4095b0be2e4363f8978a1570e0293ee093436f1e1c61d99b48502ac317025e8"},
      {"visualization_msgs::msg::dds_::MarkerArray_",
       "86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf"},
      {"octomap_msgs::msg::dds_::Octomap_",
       "9891a19a05b70ec20aa8f45db3f8300b9ab80afff32c61c549d25087da9625b0"}};
  return "RIHS01_" + kHashes.at(type.m_typename);
}

}  // namespace ros2
