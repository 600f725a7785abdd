#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "StreamTree.h"

namespace semantic_octree {

/** \file Adaptive binary range coding (Martin, "Range encoding: an algorithm for removing
 * redundancy from a digitised message", with the carry as in Subbotin's and LZMA's coders). Whole
 * numbers only: the same bytes on every machine.
 *
 * Three classes have the same functions, so that a format is written down once. bit(context, b)
 * codes a bit whose probability its context has learned. direct(value, n) codes n bits that are as
 * likely 0 as 1. A decoder gives b and value; behind the end of the bytes it reads zeros. */

/** Probabilities that a bit is 0, in 2048ths, one a context. */
using BitModels = std::vector<std::uint16_t>;
constexpr int kModelBits = 11, kModelRate = 5;

inline void learn(std::uint16_t& model, bool bit) {
  if (bit)
    model = static_cast<std::uint16_t>(model - (model >> kModelRate));
  else
    model = static_cast<std::uint16_t>(model + (((1 << kModelBits) - model) >> kModelRate));
}

class RangeEncoder {
 public:
  /** \param models in the beginning */
  explicit RangeEncoder(const BitModels& models) : m_models(models) {}

  void bit(std::size_t context, bool& b) {
    const std::uint32_t bound = (m_range >> kModelBits) * m_models[context];
    b ? (m_low += bound, m_range -= bound) : m_range = bound;
    learn(m_models[context], b);
    normalize();
  }
  void direct(std::uint64_t& value, int bits) {
    for (int i = bits - 1; i >= 0; --i) {
      m_range >>= 1;
      if (value >> i & 1) m_low += m_range;
      normalize();
    }
  }
  /** The bytes; nothing can be coded behind them. */
  std::string finish() {
    for (int i = 0; i < 5; ++i) shiftLow();
    m_bytes.erase(0, 1);  // always 0
    while (!m_bytes.empty() && m_bytes.back() == 0) m_bytes.pop_back();
    return std::move(m_bytes);
  }

 private:
  void normalize() {
    for (; m_range < 1u << 24; m_range <<= 8) shiftLow();
  }
  /** The highest byte leaves, unless a carry may still reach it. */
  void shiftLow() {
    if (m_low < 0xff000000u || m_low >> 32) {
      const auto carry = static_cast<std::uint8_t>(m_low >> 32);
      for (; m_pending > 0; --m_pending) {
        m_bytes.push_back(static_cast<char>(m_first + carry));
        m_first = 0xff;
      }
      m_first = static_cast<std::uint8_t>(m_low >> 24);
    }
    ++m_pending;
    m_low = m_low << 8 & 0xffffffffu;
  }

  BitModels m_models;
  std::string m_bytes;
  std::uint64_t m_low = 0;
  std::uint32_t m_range = 0xffffffffu;
  std::uint8_t m_first = 0;     ///< of the bytes that a carry may reach; the others are 0xff
  std::uint64_t m_pending = 1;  ///< how many these are
};

class RangeDecoder {
 public:
  RangeDecoder(const BitModels& models, const std::string& bytes)
      : m_models(models), m_bytes(bytes) {
    for (int i = 0; i < 4; ++i) m_code = m_code << 8 | nextByte();
  }

  void bit(std::size_t context, bool& b) {
    const std::uint32_t bound = (m_range >> kModelBits) * m_models[context];
    b = m_code >= bound;
    b ? (m_code -= bound, m_range -= bound) : m_range = bound;
    learn(m_models[context], b);
    normalize();
  }
  void direct(std::uint64_t& value, int bits) {
    value = 0;
    for (int i = 0; i < bits; ++i) {
      m_range >>= 1;
      const bool b = m_code >= m_range;
      if (b) m_code -= m_range;
      value = value << 1 | b;
      normalize();
    }
  }

 private:
  void normalize() {
    for (; m_range < 1u << 24; m_range <<= 8) m_code = m_code << 8 | nextByte();
  }
  std::uint32_t nextByte() {
    return m_next < m_bytes.size() ? static_cast<std::uint8_t>(m_bytes[m_next++]) : 0;
  }

  BitModels m_models;
  const std::string& m_bytes;
  std::size_t m_next = 0;
  std::uint32_t m_range = 0xffffffffu, m_code = 0;
};

/** Counts, to begin with the right probabilities. */
class BitCounter {
 public:
  explicit BitCounter(std::size_t contexts) : m_counts(contexts) {}
  void bit(std::size_t context, bool& b) { ++m_counts[context][b]; }
  void direct(std::uint64_t&, int) {}

  /** Probabilities that a bit is 0, in 256ths, 1 to 255. */
  std::string probabilities() const {
    std::string bytes;
    for (const auto& [zeros, ones] : m_counts) {
      const std::uint64_t p = (256 * zeros + 128) / (zeros + ones + 1);
      bytes.push_back(static_cast<char>(p < 1 ? 1 : p > 255 ? 255 : p));
    }
    return bytes;
  }

 private:
  std::vector<std::array<std::uint64_t, 2>> m_counts;
};

/** Parts of trees as bytes, and back. What is frequent in a map, its sender finds in all parts and
 * tells once (toText()). These are values and class records, which are then numbers of 8 bits, and
 * how likely each bit is. Bytes of one packet do not depend on those of others. */
class PartCoder {
 public:
  /** Knows nothing yet. \param rootDepth of the trees that parts belong to: octets are not above,
   * leaves that are no octet's are not below */
  PartCoder(int numClasses, int rootDepth);
  int rootDepth() const { return m_rootDepth; }
  /** Takes sorted parts of a packet. */
  using VisitGroup = std::function<void(const std::vector<const TreePart*>&)>;
  /** What is frequent in these. \param forEachGroup hands over all, the same each time */
  void learn(const std::function<void(const VisitGroup&)>& forEachGroup);

  /** \param parts at most 65535, sorted by cell */
  std::string encode(const std::vector<const TreePart*>& parts) const;
  /** \throw std::runtime_error bytes that no encoder writes; at most 65535 parts else. */
  std::vector<TreePart> decode(const std::string& bytes) const;

  std::string toText() const;
  /** \throw std::runtime_error as decode(). */
  void fromText(const std::string& text);

 private:
  template <typename Coder>
  friend class PartFormat;
  void checkRecords() const;

  int m_numClasses, m_rootDepth;
  /** By frequency, at most 255 of each. */
  std::vector<Units> m_plain, m_rests, m_differences;
  std::vector<LeafContent> m_records;
  BitModels m_models;
};

}  // namespace semantic_octree
