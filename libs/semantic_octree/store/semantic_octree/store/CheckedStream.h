#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <istream>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace semantic_octree {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "map files are little endian");

/** Bytes travel in blocks: length (4 bytes), CRC-32 (4 bytes), content. The CRC covers the blocks'
 * lengths and contents from the beginning, so that blocks cannot be exchanged. An empty block is
 * the end. */
constexpr std::size_t kMaxBlockBytes = 1 << 16;

class CheckedWriter {
 public:
  explicit CheckedWriter(std::ostream& out) : m_out(out), m_block(kMaxBlockBytes) {}
  template <typename T>
  void put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    if (m_used + sizeof(T) > kMaxBlockBytes) flush();
    std::memcpy(m_block.data() + m_used, &value, sizeof(T));
    m_used += sizeof(T);
  }
  template <typename T>
  void put(const T* values, std::size_t n) {
    static_assert(std::is_arithmetic_v<T>);
    if (m_used + n * sizeof(T) > kMaxBlockBytes) flush();
    std::memcpy(m_block.data() + m_used, values, n * sizeof(T));
    m_used += n * sizeof(T);
  }
  /** At most 65535 characters. */
  void put(const std::string& text);
  /** Writes what is left, and the end. \return the CRC of all blocks
   * \throw std::runtime_error the stream failed. */
  std::uint32_t finish();

 private:
  void flush();

  std::ostream& m_out;
  std::vector<char> m_block;
  std::size_t m_used = 0;
  std::uint32_t m_crc = 0;
};

/** \throw std::runtime_error (all functions) truncated or altered. */
class CheckedReader {
 public:
  explicit CheckedReader(std::istream& in) : m_in(in), m_block(kMaxBlockBytes) {}
  template <typename T>
  T get() {
    static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>);
    T value;
    if (m_size - m_next >= sizeof(T)) {
      std::memcpy(&value, m_block.data() + m_next, sizeof(T));
      m_next += sizeof(T);
    } else {
      getAcrossBlocks(reinterpret_cast<char*>(&value), sizeof(T));
    }
    return value;
  }
  template <typename T>
  void get(T* values, std::size_t n) {
    static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>);
    getAcrossBlocks(reinterpret_cast<char*>(values), n * sizeof(T));
  }
  std::string getText();
  /** Expects the end. */
  void finish();
  /** The CRC of all blocks up to here. */
  std::uint32_t checksum() const { return m_crc; }

 private:
  void getAcrossBlocks(char* to, std::size_t bytes);
  void nextBlock();

  std::istream& m_in;
  std::vector<char> m_block;
  std::size_t m_next = 0, m_size = 0;
  std::uint32_t m_crc = 0;
};

/** The CRC-32 of bytes behind others that have this one. */
std::uint32_t extendCrc(std::uint32_t crc, const void* bytes, std::size_t size);

/** \throw std::runtime_error the stream ends before. */
void readBytes(std::istream& in, char* to, std::size_t bytes);

}  // namespace semantic_octree
