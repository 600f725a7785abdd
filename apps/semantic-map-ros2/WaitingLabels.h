#pragma once
#include <map>
#include <memory>

#include "ros2/Node.h"

namespace semantic_map_ros2 {

/** Label images that wait for depth images with their stamps: the newest ones, as far as there is
 * room. */
class WaitingLabels {
 public:
  using Image = std::shared_ptr<const ros2::Image>;
  static constexpr std::size_t kMost = 50, kMostBytes = 500'000'000;

  /** Stamps that go back by more than 30 s begin anew. */
  void add(Image image) {
    constexpr ros2::Stamp kBack = 30'000'000'000;  // ns
    const ros2::Stamp stamp = ros2::stampOf(image->header.stamp);
    m_images.erase(m_images.upper_bound(stamp + kBack), m_images.end());
    m_images[stamp] = std::move(image);
    std::size_t bytes = 0;
    for (const auto& [at, one] : m_images) bytes += one->data._length;
    while (m_images.size() > 1 && (m_images.size() > kMost || bytes > kMostBytes)) {
      bytes -= m_images.begin()->second->data._length;
      m_images.erase(m_images.begin());
    }
  }
  bool has(ros2::Stamp stamp) const { return m_images.count(stamp) > 0; }
  /** None before it is needed any more. \return null: there is none with this stamp */
  Image take(ros2::Stamp stamp) {
    const auto it = m_images.find(stamp);
    const Image image = it == m_images.end() ? nullptr : it->second;
    m_images.erase(m_images.begin(), m_images.upper_bound(stamp));
    return image;
  }

 private:
  std::map<ros2::Stamp, Image> m_images;
};

}  // namespace semantic_map_ros2
