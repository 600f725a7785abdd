#pragma once
#include <array>
#include <cstdint>
#include <limits>

namespace colored_graph {

/** N non-negative integers, compared from the first (worst class) to the last.
 *
 * (Z_>=0^N, +, <) is strictly and totally ordered, and adding the same vector on both sides keeps
 * the order: all that Dijkstra, A* and LPA* ask of a cost. A sum that overflows in any component is
 * infinite(), which is larger than every other vector. */
template <int N>
class CostVector {
 public:
  constexpr CostVector() : m_parts{} {}

  static constexpr CostVector infinite() {
    CostVector cost;
    for (std::int64_t& part : cost.m_parts) part = kLargest;
    return cost;
  }
  bool isInfinite() const { return *this == infinite(); }

  std::int64_t operator[](int i) const { return m_parts[i]; }
  std::int64_t& operator[](int i) { return m_parts[i]; }

  /** Negative, 0 or positive, as l is less than, equal to or greater than r. */
  friend int compare(const CostVector& l, const CostVector& r) {
    for (int i = 0; i < N; ++i)
      if (l.m_parts[i] != r.m_parts[i]) return l.m_parts[i] < r.m_parts[i] ? -1 : 1;
    return 0;
  }
  friend bool operator==(const CostVector& l, const CostVector& r) { return compare(l, r) == 0; }
  friend bool operator!=(const CostVector& l, const CostVector& r) { return compare(l, r) != 0; }
  friend bool operator<(const CostVector& l, const CostVector& r) { return compare(l, r) < 0; }
  friend bool operator>(const CostVector& l, const CostVector& r) { return compare(l, r) > 0; }
  friend bool operator<=(const CostVector& l, const CostVector& r) { return compare(l, r) <= 0; }
  friend bool operator>=(const CostVector& l, const CostVector& r) { return compare(l, r) >= 0; }

  friend CostVector operator+(const CostVector& l, const CostVector& r) {
    CostVector sum;
    std::uint64_t seen = 0;  // the top bit tells whether any component left the range
    for (int i = 0; i < N; ++i) {
      const std::uint64_t part =
          static_cast<std::uint64_t>(l.m_parts[i]) + static_cast<std::uint64_t>(r.m_parts[i]);
      seen |= part;
      sum.m_parts[i] = static_cast<std::int64_t>(part);
    }
    return seen >> 63 ? infinite() : sum;
  }

 private:
  static constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();

  std::array<std::int64_t, N> m_parts;
};

}  // namespace colored_graph
