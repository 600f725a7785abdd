#pragma once
#include <semantic_octree/store/TreeFormat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <istream>
#include <ostream>
#include <stdexcept>
#include <type_traits>
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
    put(&value, 1);
  }
  template <typename T>
  void put(const T* values, std::size_t n) {
    static_assert(std::is_arithmetic_v<T>);
    if (m_used + n * sizeof(T) > kMaxBlockBytes) flush();
    std::memcpy(m_block.data() + m_used, values, n * sizeof(T));
    m_used += n * sizeof(T);
  }
  /** At most 65535 characters. */
  void put(const std::string& text) {
    if (text.size() > UINT16_MAX)
      throw std::runtime_error("a name of " + std::to_string(text.size()) +
                               " characters is too long for a map file");
    put(static_cast<std::uint16_t>(text.size()));
    for (const char c : text) put(c);
  }
  /** Writes what is left, and the end. \return the CRC of all blocks
   * \throw std::runtime_error the stream failed. */
  std::uint32_t finish() {
    if (m_used > 0) flush();
    flush();
    if (!m_out)
      throw std::runtime_error("the map could not be written completely: " +
                               std::string(std::strerror(errno)));
    return m_crc;
  }

 private:
  void flush() {
    const std::uint32_t length = static_cast<std::uint32_t>(m_used);
    m_crc = extendCrc(extendCrc(m_crc, &length, sizeof(length)), m_block.data(), m_used);
    m_out.write(reinterpret_cast<const char*>(&length), sizeof(length));
    m_out.write(reinterpret_cast<const char*>(&m_crc), sizeof(m_crc));
    m_out.write(m_block.data(), static_cast<std::streamsize>(m_used));
    m_used = 0;
  }

  std::ostream& m_out;
  std::vector<char> m_block;
  std::size_t m_used = 0;
  std::uint32_t m_crc = 0;
};

/** \throw std::runtime_error the stream ends before. */
inline void readBytes(std::istream& in, char* to, std::size_t bytes) {
  in.read(to, static_cast<std::streamsize>(bytes));
  if (static_cast<std::size_t>(in.gcount()) != bytes) throw std::runtime_error("truncated");
}

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
  std::string getText() {
    std::string text(get<std::uint16_t>(), '\0');
    for (char& c : text) c = get<char>();
    return text;
  }
  /** Expects the end. */
  void finish() {
    if (m_next == m_size) nextBlock();
    if (m_size > 0) throw std::runtime_error("altered: more content than its counts tell");
  }
  /** The CRC of all blocks up to here. */
  std::uint32_t checksum() const { return m_crc; }

 private:
  void getAcrossBlocks(char* to, std::size_t bytes) {
    while (bytes > 0) {
      if (m_next == m_size) {
        nextBlock();
        if (m_size == 0) throw std::runtime_error("altered: its content ends too early");
      }
      const std::size_t part = std::min(bytes, m_size - m_next);
      std::memcpy(to, m_block.data() + m_next, part);
      m_next += part, to += part, bytes -= part;
    }
  }
  void nextBlock() {
    std::uint32_t length = 0, crc = 0;
    readBytes(m_in, reinterpret_cast<char*>(&length), sizeof(length));
    readBytes(m_in, reinterpret_cast<char*>(&crc), sizeof(crc));
    if (length > kMaxBlockBytes)
      throw std::runtime_error("altered: a block of " + std::to_string(length) + " bytes");
    readBytes(m_in, m_block.data(), length);
    m_crc = extendCrc(extendCrc(m_crc, &length, sizeof(length)), m_block.data(), length);
    if (m_crc != crc) throw std::runtime_error("altered: a checksum does not match");
    m_next = 0;
    m_size = length;
  }

  std::istream& m_in;
  std::vector<char> m_block;
  std::size_t m_next = 0, m_size = 0;
  std::uint32_t m_crc = 0;
};

/** A map's bytes: kMagic, kVersion, then in checked blocks
 *   resolution (double), pruning (1 byte), filter (1 byte: whether classes have factors, nine
 * doubles),
 *   classes: number (1 byte), each name (2 bytes length, characters), r, g, b,
 *            policy for unknown raw ids (1 byte), folds (4 bytes number; raw id 4 bytes, class 1
 * byte),
 *   half-lives of free space and of each class (doubles, seconds; 0: none), the map's clock (8
 *   bytes, nanoseconds), factors of classes if there are any (doubles),
 * number of nodes (8 bytes; 0: the map is empty), the root's NodeKind (1 byte) and value,
 * then from each inner node on, depth first: two bits of NodeKind per child (2 bytes), the leaves'
 * values, the inner children. The value of a leaf is its log-odds. Its class record, if any, has
 * the number of named classes (1 byte), the rest's log-odds, and id (1 byte) and log-odds of each.
 * Log-odds are 2 bytes, in units of 1/1024. Inner nodes' values follow from their children.
 *
 * An inner node at depth 14 is a block. First come which octants are known, leaves, leaves with a
 * record (1 byte each). Then each known octant that is no leaf: which voxels are known, which have
 * a record (1 byte each). Last come all log-odds, then all records, in the order of the voxels. */
constexpr std::array<char, 8> kMagic{'S', 'E', 'M', 'O', 'C', 'T', 'R', 'E'};
constexpr std::uint32_t kVersion = 5;

enum class NodeKind : std::uint8_t { None, Leaf, LeafWithRecord, Inner };

/** The numbers of a map's filter that files have, in order. */
template <class Parameters>
auto numbersOf(Parameters& p) {
  return std::array{&p.accuracy,         &p.hitProbability,    &p.falseAlarmProbability,
                    &p.minOccupancy,     &p.maxProbability,    &p.softLabelFloor,
                    &p.labelCorrelation, &p.calibration.power, &p.calibration.shared};
}

}  // namespace semantic_octree
