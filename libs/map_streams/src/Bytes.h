#pragma once
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace semantic_octree {

/** Puts values behind each other, little endian and without gaps. A ByteReader has the same
 * functions, so that a format is written down once. */
class ByteWriter {
 public:
  template <typename T>
  void value(const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  /** Seven bits a byte, the lowest first. */
  void number(std::uint64_t n) {
    for (; n > 0x7f; n >>= 7) value(static_cast<std::uint8_t>(n | 0x80));
    value(static_cast<std::uint8_t>(n));
  }
  void flag(bool b) { value(static_cast<std::uint8_t>(b)); }
  void text(const std::string& text) {
    value(static_cast<std::uint32_t>(text.size()));
    bytes += text;
  }
  /** \param values at most 255 */
  template <typename T>
  void list(const std::vector<T>& values) {
    value(static_cast<std::uint8_t>(values.size()));
    for (const T& each : values) value(each);
  }

  std::string bytes;
};

/** \throw std::runtime_error the bytes end too early. */
class ByteReader {
 public:
  explicit ByteReader(const std::string& bytes, std::size_t at = 0) : m_bytes(bytes), m_next(at) {}
  template <typename T>
  void value(T& value) {
    need(sizeof(T));
    std::memcpy(&value, m_bytes.data() + m_next, sizeof(T));
    m_next += sizeof(T);
  }
  template <typename T>
  T take() {
    T taken;
    value(taken);
    return taken;
  }
  std::uint64_t number() {
    std::uint64_t n = 0;
    for (int shift = 0; shift < 63; shift += 7) {
      const auto byte = take<std::uint8_t>();
      n |= std::uint64_t(byte & 0x7f) << shift;
      if (byte < 0x80) return n;
    }
    throw std::runtime_error("altered: a number that does not end");
  }
  void flag(bool& b) { b = take<std::uint8_t>() != 0; }
  void text(std::string& text) {
    const auto size = take<std::uint32_t>();
    need(size);
    text = m_bytes.substr(m_next, size);
    m_next += size;
  }
  template <typename T>
  void list(std::vector<T>& values) {
    values.resize(take<std::uint8_t>());
    for (T& each : values) value(each);
  }
  std::string rest() const { return m_bytes.substr(m_next); }

 private:
  void need(std::size_t size) const {
    if (m_bytes.size() - m_next < size) throw std::runtime_error("altered: it ends too early");
  }

  const std::string& m_bytes;
  std::size_t m_next;
};

}  // namespace semantic_octree
