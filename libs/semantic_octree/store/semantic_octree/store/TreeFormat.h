#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_octree/store/CheckedStream.h>
#include <semantic_octree/store/LeafContent.h>

#include <array>
#include <cstdint>

namespace semantic_octree {

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
