#pragma once
#include <cstdint>

namespace colored_graph {

__extension__ typedef unsigned __int128 Bits128;

/** A cost vector in 128 bits, compared as one number; where its components stand is PackedLayout's.
 * Of no more alignment than its halves, so that labels stay small. */
class PackedCost {
 public:
  static constexpr int kBits = 128;

  PackedCost() = default;
  explicit PackedCost(Bits128 bits)
      : m_low(static_cast<std::uint64_t>(bits)), m_high(static_cast<std::uint64_t>(bits >> 64)) {}
  static PackedCost infinite() { return PackedCost(~Bits128{0}); }

  Bits128 bits() const { return Bits128{m_high} << 64 | m_low; }
  bool isInfinite() const { return bits() == ~Bits128{0}; }

  friend bool operator==(const PackedCost& l, const PackedCost& r) { return l.bits() == r.bits(); }
  friend bool operator<(const PackedCost& l, const PackedCost& r) { return l.bits() < r.bits(); }
  friend PackedCost operator+(const PackedCost& l, const PackedCost& r) {
    return PackedCost(l.bits() + r.bits());
  }
  /** One above the place of the highest bit in which they differ; 0 if they are equal. */
  friend int highestDifference(const PackedCost& l, const PackedCost& r) {
    if (const std::uint64_t high = l.m_high ^ r.m_high) return 128 - __builtin_clzll(high);
    const std::uint64_t low = l.m_low ^ r.m_low;
    return low ? 64 - __builtin_clzll(low) : 0;
  }

 private:
  std::uint64_t m_low = 0, m_high = 0;
};

}  // namespace colored_graph
