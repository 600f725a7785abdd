#include "ScanQueue.h"

#include <strict_files/Words.h>

#include <algorithm>
#include <utility>

namespace semantic_map_ros2 {

namespace {
constexpr std::size_t kMostBytes = 500'000'000;
}

void ScanQueue::push(WaitingScan scan) {
  scan.cameAt = m_surroundings.now();
  scan.came = std::chrono::steady_clock::now();
  const std::string topic = scan.topic;
  bool isFull = false;
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    if (m_isClosed) return;
    const auto later = std::find_if(m_scans.rbegin(), m_scans.rend(),
                                    [&](const auto& other) { return other.stamp <= scan.stamp; });
    m_bytes += scan.bytes;
    m_scans.insert(later.base(), std::move(scan));
    for (; m_bytes > kMostBytes && m_scans.size() > 1; isFull = true) {
      m_bytes -= m_scans.front().bytes;
      m_scans.pop_front();
    }
  }
  wake();
  if (isFull)
    m_surroundings.complain(topic +
                            ": scans come faster than they are inserted; the oldest are left out");
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

void ScanQueue::close() {
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_isClosed = true;
}

auto ScanQueue::placeOf(const WaitingScan& scan) const -> Place {
  const auto robot = m_surroundings.find(m_options.worldFrame(), m_options.baseFrame, scan.stamp);
  const auto points = m_surroundings.find(m_options.baseFrame, scan.frame, scan.stamp);
  return {robot.T_target_source, points.T_target_source,
          robot.T_target_source ? points.problem : robot.problem, robot.isLost || points.isLost};
}

bool ScanQueue::isDue(const WaitingScan& scan) const {
  const double waited = double(m_surroundings.now() - scan.cameAt) * 1e-9;
  if (waited >= m_options.transformTimeout || waited < 0) return true;  // < 0: a bag began anew
  const Place place = placeOf(scan);
  const bool isPlaced = place.T_world_robot && place.T_robot_points;
  return place.isLost || (isPlaced && (!scan.isComplete || scan.isComplete()));
}

bool ScanQueue::insertNext(const Insert& insert) {
  WaitingScan scan;
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    const auto due = std::find_if(m_scans.begin(), m_scans.end(),
                                  [this](const WaitingScan& waiting) { return isDue(waiting); });
    if (due == m_scans.end()) return false;
    scan = std::move(*due);
    m_scans.erase(due);
    m_bytes -= scan.bytes;
  }
  Place place = placeOf(scan);
  if (place.T_world_robot && place.T_robot_points) try {
      semantic_slam::SensorScan seen = scan.read();
      seen.T_robot_sensor = *place.T_robot_points * scan.T_frame_points;
      insert(scan, std::move(seen), *place.T_world_robot);
      return true;
    } catch (const std::exception& e) {
      place.problem = strict_files::messageOf(e);
    }
  ++m_leftOut;
  m_surroundings.complain(scan.topic + ": scans are left out: " + place.problem);
  return true;
}

}  // namespace semantic_map_ros2
