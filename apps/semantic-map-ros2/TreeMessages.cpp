#include "TreeMessages.h"

#include <stdexcept>
#include <utility>

namespace semantic_map_ros2 {

TreeMessages::TreeMessages(ros2::Node& node, semantic_octree::SemanticOcTree& map,
                           std::string frame)
    : m_map(map),
      m_frame(std::move(frame)),
      m_teller(map),
      m_writesChanges(node, "~/change", {true, false, TreeTeller::kMostChanges}),
      m_writesAll(node, "~/compressed", {true, false, 1}) {}

void TreeMessages::publish(ros2::Stamp stamp) {
  const auto writer = [&](ros2::Publication<ros2::Octomap>& to) {
    return [this, &to, stamp](std::string data) { write(to, std::move(data), stamp); };
  };
  const TreeTeller::Write all = writer(m_writesAll);
  m_teller.tell(isRead(), writer(m_writesChanges), isAsked() ? all : nullptr);
}

void TreeMessages::write(ros2::Publication<ros2::Octomap>& to, std::string bytes,
                         ros2::Stamp stamp) {
  ros2::Octomap message{};
  message.header = ros2::headerOf(stamp, m_frame);
  message.id = ros2::textOf(TreeTeller::kId);
  message.resolution = m_map.getResolution();
  message.data._length = message.data._maximum = static_cast<std::uint32_t>(bytes.size());
  message.data._buffer = reinterpret_cast<std::uint8_t*>(bytes.data());
  to.write(message);
}

TreeReader::TreeReader(ros2::Node& node, const std::string& of)
    : m_node(node),
      m_allName(of + "/compressed"),
      m_hearsChanges(node, of + "/change", {true, false, TreeTeller::kMostChanges},
                     [this](const Message& message) { take(message, false); }) {}

void TreeReader::take(const Message& message, bool isAll) {
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_isAnswered |= isAll;
  try {
    if (ros2::textOf(message->id) != TreeTeller::kId)
      throw std::runtime_error("a message of '" + ros2::textOf(message->id) + "', expected " +
                               TreeTeller::kId);
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
