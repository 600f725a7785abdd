#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace bags {

/** Bytes of a chunk, or a message, that is larger are refused. */
constexpr std::uint64_t kMostChunkBytes = std::uint64_t{1} << 30;

/** A topic of a bag. */
struct BagTopic {
  std::string name, type;  ///< "/lidar/points", "sensor_msgs/msg/PointCloud2"

  bool operator<(const BagTopic& o) const { return name != o.name ? name < o.name : type < o.type; }
};

/** Takes a message. \return whether to go on */
using TakeMessage = std::function<bool(const BagTopic&, std::string_view message)>;
/** Whether messages of a topic are wanted. */
using WantsTopic = std::function<bool(const BagTopic&)>;

/** The files of a bag of ROS 2: itself, or, of a folder, its .mcap and .db3 files in the order of
 * their numbers. \throw std::runtime_error naming it: there are none, or it is of another kind. */
std::vector<std::filesystem::path> filesOfBag(const std::filesystem::path& bag);

/** Reads all messages of some topics, in the order in which they are stored (.mcap) or were
 * received (.db3). Memory is that of one message, or chunk.
 * \throw std::runtime_error naming the file: it is no bag, or damaged; or what `take` throws, with
 * the file's name. */
void readBag(const std::filesystem::path& bag, const WantsTopic& wants, const TakeMessage& take);

/** The topics of a bag. \throw std::runtime_error as readBag(). */
std::set<BagTopic> topicsOfBag(const std::filesystem::path& bag);

// These read one file. The summary section of MCAP is not read.
void readMcap(const std::filesystem::path& file, const WantsTopic& wants, const TakeMessage& take);
void readSqliteBag(const std::filesystem::path& file, const WantsTopic& wants,
                   const TakeMessage& take);

}  // namespace bags
