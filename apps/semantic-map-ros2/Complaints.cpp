#include "Complaints.h"

#include <iostream>

namespace semantic_map_ros2 {

namespace {
constexpr std::size_t kMostKinds = 100;  // peers cannot fill memory
}

void Complaints::say(const std::string& what, const std::string& details) {
  const std::lock_guard<std::mutex> lock(m_mutex);
  if (m_counts.size() >= kMostKinds && m_counts.count(what) == 0) return;
  if (++m_counts[what] == 1)
    std::cerr << "Warning: " << what << (details.empty() ? "" : " (" + details + ")") << std::endl;
}

void Complaints::sum() const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  for (const auto& [what, count] : m_counts)
    if (count > 1) std::cerr << "Warning: " << count << " times: " << what << std::endl;
}

}  // namespace semantic_map_ros2
