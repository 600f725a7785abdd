#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

namespace map_pictures {

/** How low a map is around each place: its ground, where that was seen. */
class LowestCells {
 public:
  /** \param center, edge of a cell, m */
  void add(const Eigen::Vector3f& center, float edge) {
    const int left = squareOf(center.x() - edge / 2), right = squareOf(center.x() + edge / 2);
    const int below = squareOf(center.y() - edge / 2), above = squareOf(center.y() + edge / 2);
    for (int y = below; y <= above; ++y)
      for (int x = left; x <= right; ++x)
        if (lower(m_own, x, y, center.z())) addAround(x, y, center.z());
  }

  /** In the square of 1.5 m where a place is, or in one next to it; infinite if there is none. m */
  float around(float x, float y) const {
    const auto found = m_around.find(keyOf(squareOf(x), squareOf(y)));
    return found == m_around.end() ? std::numeric_limits<float>::infinity() : found->second;
  }

 private:
  using Squares = std::unordered_map<std::int64_t, float>;

  static int squareOf(float meters) {
    constexpr float kEdge = 1.5f;
    return static_cast<int>(std::floor(meters / kEdge));
  }
  static std::int64_t keyOf(int x, int y) {
    return std::int64_t(x) * (std::int64_t(1) << 32) + std::uint32_t(y);
  }
  static bool lower(Squares& squares, int x, int y, float z) {
    const auto [square, isNew] = squares.emplace(keyOf(x, y), z);
    if (!isNew && square->second <= z) return false;
    square->second = z;
    return true;
  }
  void addAround(int x, int y, float z) {
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) lower(m_around, x + dx, y + dy, z);
  }

  Squares m_own, m_around;
};

}  // namespace map_pictures
