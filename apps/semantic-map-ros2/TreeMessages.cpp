#include "TreeMessages.h"

#include <chrono>
#include <stdexcept>
#include <utility>

namespace semantic_map_ros2 {

namespace {

const std::string kId = "SemanticTree";
constexpr int kChanges = 100;  // that wait for readers that are slow

/** No two runs have the same. */
std::uint32_t numberOfRun() {
  return static_cast<std::uint32_t>(std::chrono::system_clock::now().time_since_epoch().count());
}

}  // namespace

TreeMessages::TreeMessages(ros2::Node& node, semantic_octree::SemanticOcTree& map,
                           std::string frame)
    : m_map(map),
      m_frame(std::move(frame)),
      m_writesChanges(node, "~/change", {true, false, kChanges}),
      m_writesAll(node, "~/compressed", {true, false, 1}) {}

void TreeMessages::publish(ros2::Stamp stamp) {
  if (!isRead()) return m_broadcast.reset();
  if (!m_broadcast) m_broadcast.emplace(m_map, numberOfRun());
  if (std::string change = m_broadcast->change(); !change.empty())
    write(m_writesChanges, std::move(change), stamp);
  if (isAsked()) write(m_writesAll, m_broadcast->all(), stamp);
}

void TreeMessages::write(ros2::Publication<ros2::Octomap>& to, std::string bytes,
                         ros2::Stamp stamp) {
  ros2::Octomap message{};
  message.header = ros2::headerOf(stamp, m_frame);
  message.id = ros2::textOf(kId);
  message.resolution = m_map.getResolution();
  message.data._length = message.data._maximum = static_cast<std::uint32_t>(bytes.size());
  message.data._buffer = reinterpret_cast<std::uint8_t*>(bytes.data());
  to.write(message);
}

TreeReader::TreeReader(ros2::Node& node, const std::string& of)
    : m_node(node),
      m_allName(of + "/compressed"),
      m_hearsChanges(node, of + "/change", {true, false, kChanges},
                     [this](const Message& message) { take(message, false); }) {}

void TreeReader::take(const Message& message, bool isAll) {
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_isAnswered |= isAll;
  try {
    if (ros2::textOf(message->id) != kId)
      throw std::runtime_error("a message of '" + ros2::textOf(message->id) + "', expected " + kId);
    m_isLacking = !m_copy.accept(
        {reinterpret_cast<const char*>(message->data._buffer), std::size_t(message->data._length)});
    m_hasMap |= !m_isLacking;
  } catch (const std::exception& e) {
    m_problem = e.what();
    m_isLacking = true;
  }
}

std::string TreeReader::look() {
  bool isToAsk, isDone;
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    isDone = !m_isLacking;
    isToAsk = m_isLacking && m_isAnswered;
    if (isToAsk) m_isAnswered = false;
  }
  if (isDone || isToAsk) m_hearsAll.reset();
  if (isToAsk)
    m_hearsAll.emplace(m_node, m_allName, ros2::Qos{true, false, 1},
                       [this](const Message& message) { take(message, true); });
  const std::lock_guard<std::mutex> lock(m_mutex);
  return std::exchange(m_problem, {});
}

bool TreeReader::isCurrent() const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  return m_copy.isCurrent();
}

std::optional<semantic_octree::SemanticOcTree> TreeReader::map() const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  if (!m_hasMap) return std::nullopt;
  return m_copy.map();
}

}  // namespace semantic_map_ros2
