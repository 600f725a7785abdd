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
  explicit ByteReader(const std::string& bytes) : m_bytes(bytes) {}
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
  std::size_t m_next = 0;
};

}  // namespace semantic_octree
