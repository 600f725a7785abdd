#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace bags {

struct BagTopic {
  std::string name, type;  ///< "/lidar/points", "sensor_msgs/msg/PointCloud2"
};

/** Takes a message. \return whether to go on */
using TakeMessage = std::function<bool(const BagTopic&, std::string_view message)>;
/** Whether messages of a topic are wanted. */
using WantsTopic = std::function<bool(const BagTopic&)>;

/** Reads all messages of some topics of a ROS 2 bag, or of a folder's .mcap and .db3 files in the
 * order of their numbers. Messages come as they are stored (.mcap) or were received (.db3). Memory
 * is that of one message, or chunk.
 * \throw std::runtime_error naming the file: it is no bag, or damaged; or what `take` throws, with
 * the file's name. */
void readBag(const std::filesystem::path& bag, const WantsTopic& wants, const TakeMessage& take);

}  // namespace bags
