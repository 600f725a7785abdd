#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "point_fields/PointFields.h"

namespace bags {

/** Reads bytes one after the other, and never beyond their end.
 * \throw std::runtime_error in all functions: they end too early */
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : m_bytes(bytes) {}

  bool atEnd() const { return m_at == m_bytes.size(); }
  std::size_t left() const { return m_bytes.size() - m_at; }
  std::size_t place() const { return m_at; }

  std::string_view bytes(std::uint64_t count) {
    if (count > left())
      throw std::runtime_error("ends too early: " + std::to_string(count) + " bytes expected, " +
                               std::to_string(left()) + " are left");
    const std::string_view result = m_bytes.substr(m_at, static_cast<std::size_t>(count));
    m_at += static_cast<std::size_t>(count);
    return result;
  }
  /** A number, lowest byte first, or the other way round. */
  template <class T>
  T number(bool isBigEndian = false) {
    const char* place = bytes(sizeof(T)).data();
    return point_fields::numberAt<T>(reinterpret_cast<const std::uint8_t*>(place), isBigEndian);
  }
  /** A text, which its length in four bytes precedes. */
  std::string_view text() { return bytes(number<std::uint32_t>()); }

 private:
  std::string_view m_bytes;
  std::size_t m_at = 0;
};

}  // namespace bags
