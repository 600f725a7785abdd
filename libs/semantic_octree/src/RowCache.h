#pragma once
#include <cstdint>
#include <cstring>
#include <vector>

#include "NodeStore.h"

namespace semantic_octree {

inline std::size_t hashOf(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits * 0x9e3779b97f4a7c15u;
}

inline std::size_t hashOf(const Belief& belief) {
  std::uint32_t bits[5];
  static_assert(sizeof(Belief) == sizeof bits);
  std::memcpy(bits, &belief, sizeof bits);
  std::size_t hash = 0;
  for (const std::uint32_t b : bits) hash = (hash ^ b) * 0x9e3779b97f4a7c15u;
  return hash ^ hash << 32;
}

/** Rows of leaves (see RowLayout) by what the leaves hold. A few values make up most of a map, and
 * a row takes exponentials and logarithms to compute. A row stays where it is until release(). */
template <typename Key>
class RowCache {
 public:
  explicit RowCache(int rowSize)
      : m_rowSize(rowSize), m_slots(kSlots), m_rows((kSlots + kInUse) * rowSize) {}

  /** Rows asked for up to now are not in use any more. At most eight are between two releases. */
  void release() {
    ++m_age;
    m_numSpares = 0;
  }

  /** \param compute computes a row that is not there: compute(key, row) */
  template <typename F>
  const double* row(const Key& key, const F& compute) {
    const std::size_t i = hashOf(key) >> (64 - kSlotBits);
    Slot& slot = m_slots[i];
    if (slot.usedAt != 0 && slot.key == key) {
      slot.usedAt = m_age;
      return &m_rows[i * m_rowSize];
    }
    return newRow(key, i, compute);
  }

 private:
  static constexpr int kSlotBits = 11, kInUse = 8;
  static constexpr std::size_t kSlots = std::size_t(1) << kSlotBits;
  struct Slot {
    Key key{};
    std::uint64_t usedAt = 0;  ///< 0: empty
  };

  template <typename F>
  const double* newRow(const Key& key, std::size_t i, const F& compute) {
    const bool inUse = m_slots[i].usedAt == m_age;
    double* const row = &m_rows[(inUse ? kSlots + m_numSpares++ : i) * m_rowSize];
    compute(key, row);
    if (!inUse) m_slots[i] = {key, m_age};
    return row;
  }

  std::size_t m_rowSize;
  std::uint64_t m_age = 1;
  std::size_t m_numSpares = 0;
  std::vector<Slot> m_slots;
  std::vector<double> m_rows;  ///< of the slots, then spare ones for keys that meet in a slot
};

}  // namespace semantic_octree
