#include "ScanQueue.h"

#include <algorithm>

namespace semantic_map_ros2 {

std::size_t ScanQueue::push(WaitingScan scan) {
  const std::lock_guard<std::mutex> lock(m_mutex);
  const auto later = std::find_if(m_scans.rbegin(), m_scans.rend(), [&](const WaitingScan& other) {
    return other.stamp <= scan.stamp;
  });
  m_bytes += scan.bytes;
  m_scans.insert(later.base(), std::move(scan));
  std::size_t gone = 0;
  for (; m_bytes > m_mostBytes && m_scans.size() > 1; ++gone) {
    m_bytes -= m_scans.front().bytes;
    m_scans.pop_front();
  }
  m_isNew = true;
  m_changed.notify_one();
  return gone;
}

void ScanQueue::wait(std::chrono::milliseconds atMost) {
  std::unique_lock<std::mutex> lock(m_mutex);
  m_changed.wait_for(lock, atMost, [this] { return m_isNew; });
  m_isNew = false;
}

void ScanQueue::wake() {
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_isNew = true;
  m_changed.notify_one();
}

std::optional<WaitingScan> ScanQueue::take(const std::function<bool(const WaitingScan&)>& accepts) {
  const std::lock_guard<std::mutex> lock(m_mutex);
  const auto it = std::find_if(m_scans.begin(), m_scans.end(), accepts);
  if (it == m_scans.end()) return std::nullopt;
  WaitingScan scan = std::move(*it);
  m_scans.erase(it);
  m_bytes -= scan.bytes;
  return scan;
}

}  // namespace semantic_map_ros2
