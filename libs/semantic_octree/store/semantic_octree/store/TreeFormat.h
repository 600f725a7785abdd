#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_octree/store/LeafContent.h>

#include <algorithm>
#include <array>
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

/** A map's bytes: kMagic, kVersion, then in checked blocks (see CheckedStream.h)
 *   resolution (double), pruning (1 byte), filter (1 byte that is 0, nine doubles),
 *   classes: number (1 byte), each name (2 bytes length, characters), r, g, b,
 *            policy for unknown raw ids (1 byte), folds (4 bytes number; raw id 4 bytes, class 1
 * byte),
 *   half-lives of free space and of each class (doubles, seconds; 0: none), the map's clock (8
 *   bytes, nanoseconds),
 * number of nodes (8 bytes; 0: the map is empty), the root's NodeKind (1 byte) and value,
 * then from each inner node on, depth first: two bits of NodeKind per child (2 bytes), the leaves'
 * values, the inner children. The value of a leaf is its log-odds; with a class record, followed by
 * the number of named classes (1 byte), the rest's log-odds, and id (1 byte) and log-odds of each.
 * Log-odds are 2 bytes, in units of 1/1024. Inner nodes' values follow from their children.
 *
 * An inner node at depth 14 is a block: which octants are known, leaves, leaves with a record (1
 * byte each); of each known octant that is no leaf, which voxels are known, which have a record (1
 * byte each); all log-odds, then all records, in the order of the voxels. */
constexpr std::array<char, 8> kMagic{'S', 'E', 'M', 'O', 'C', 'T', 'R', 'E'};
constexpr std::uint32_t kVersion = 5;

enum class NodeKind : std::uint8_t { None, Leaf, LeafWithRecord, Inner };

/** Writes a map's content after magic and version. */
class TreeWriter {
 public:
  TreeWriter(std::ostream& out, const SemanticOcTree& tree);
  /** \return its checksum: the CRC of all blocks */
  std::uint32_t write();
  /** A map of nothing but one inner node above the blocks, and its ancestors.
   * \param nodes below it \return its checksum */
  std::uint32_t writeTile(const Slot& octant, const Cell& cell, std::uint64_t nodes);

 private:
  void putHeader();
  void putParameters(const FilterParameters& p);
  void putClasses(const ClassTable& classes);
  void putTime();
  void putSlot(const Slot& slot);
  void putLeaf(const Slot& leaf);
  void putRecord(const ClassRecord& record);
  void putChildren(const Octant& octant);
  void putBlock(const Block& block);
  static NodeKind kindOf(const Slot& slot);

  CheckedWriter m_out;
  const SemanticOcTree& m_tree;
  const NodeStore& m_store;
};

/** Reads a map's content after magic and version. What the checksums let pass is
 * checked too, so that no input leads to a broken tree.
 * \throw std::runtime_error, std::invalid_argument (bad parameters or classes). */
class TreeReader {
 public:
  explicit TreeReader(std::istream& in) : m_in(in) {}
  SemanticOcTree read();
  /** What writeTile() wrote of a map that is like this one: adds the children of an octant that has
   * none. If it fails, some of them may be there. */
  void readTile(const SemanticOcTree& tree, NodeArena& arena, Octant& octant, const Cell& cell);
  /** The checksum of what was read. */
  std::uint32_t checksum() const { return m_in.checksum(); }

 private:
  SemanticOcTree getHeader();
  void begin(const SemanticOcTree& tree, NodeArena& arena);
  static void checkNodes(std::uint64_t found, std::uint64_t expected);
  void fill(Octant& octant, int depth);
  FilterParameters getParameters();
  ClassTable getClasses();
  /** Half-lives. \return the clock */
  std::int64_t getTime(ClassTable& classes);
  void getNodes(SemanticOcTree& tree, std::uint64_t expectedNodes);
  void getNode(Slot& slot, NodeKind kind, int depth);
  void getChildren(Slot& inner, int depth);
  /** Two bits of NodeKind per child. */
  std::uint16_t getKinds();
  void getBlock(Slot& inner);
  BlockContent getBlockContent();
  void getValues(BlockContent& block);
  LeafContent getLeaf(bool hasRecord);
  ClassRecord getRecord();
  /** One byte, 0 to `last`. */
  std::uint8_t getUpTo(int last, const char* what);
  Units getLogOdds();

  CheckedReader m_in;
  NodeStore* m_store = nullptr;
  NodeArena* m_arena = nullptr;
  int m_numClasses = 0;
};

/** As loadTree(). \param checksum becomes that of the file */
SemanticOcTree loadTreeFile(const std::string& path, std::uint32_t* checksum = nullptr);
/** As saveTree(), but not yet on the disk. \return the file's checksum */
std::uint32_t saveTreeFile(const SemanticOcTree& tree, const std::string& path);

/** A tile's file, see TreeWriter::writeTile(); not yet on the disk. \return the file's checksum
 * \throw std::runtime_error naming the file */
std::uint32_t saveTile(const SemanticOcTree& tree, const Slot& octant, const Cell& cell,
                       std::uint64_t nodes, const std::string& path);
/** See TreeReader::readTile(). \return the file's checksum \throw std::runtime_error naming the
 * file
 */
std::uint32_t loadTile(const SemanticOcTree& tree, NodeArena& arena, Octant& octant,
                       const Cell& cell, const std::string& path);

}  // namespace semantic_octree
