#pragma once
#include <semantic_octree/store/ClassRecord.h>
#include <semantic_octree/store/Cubes.h>
#include <semantic_octree/store/IndexPool.h>

#include <algorithm>
#include <atomic>
#include <bitset>
#include <deque>
#include <memory>
#include <optional>

namespace semantic_octree {

using VoxelBits = std::uint64_t;

/** The bits of one of a block's eight octants. */
inline std::uint8_t octantOf(VoxelBits bits, int octant) {
  return static_cast<std::uint8_t>(bits >> 8 * octant);
}
/** A bit for each octant that has any. */
inline std::uint8_t octantsWith(VoxelBits bits) {
  bits |= bits >> 4;
  bits |= bits >> 2;
  bits |= bits >> 1;
  return static_cast<std::uint8_t>((bits & 0x0101010101010101) * 0x0102040810204080 >> 56);
}
inline int countOf(VoxelBits bits) {
  bits -= bits >> 1 & 0x5555555555555555;
  bits = (bits & 0x3333333333333333) + (bits >> 2 & 0x3333333333333333);
  return static_cast<int>(((bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0f) * 0x0101010101010101 >> 56);
}

/** A node at depth 14 or above. Its value is its log-odds, an inner node's that of its most
 * occupied leaf. */
struct Slot {
  enum class Kind : std::uint8_t {
    None,            ///< unknown space
    Leaf,            ///< without a class record
    LeafWithRecord,  ///< `index` is the record's
    Octant,          ///< inner node; `index` is that of its children
    Block,           ///< inner node at depth 14; `index` is the block's
    Away             ///< inner node whose children are in a file; `index` is where they come back
                     ///< and until then what TilesOnDisk knows it by
  };
  std::uint32_t index = 0;
  Units value = 0;
  Kind kind = Kind::None;

  bool isKnown() const { return kind != Kind::None; }
  bool isLeaf() const { return kind == Kind::Leaf || kind == Kind::LeafWithRecord; }
  bool isInner() const { return kind >= Kind::Octant; }
};
static_assert(sizeof(Slot) == 8);

/** The children of an inner node. */
struct Octant {
  Slot slots[8];
};

/** All that is below an inner node at depth 14: 4 x 4 x 4 voxels in Morton order (x lowest). Eight
 * in a row are an octant, one of the block's children. */
struct Block {
  static constexpr int kDepth = 14;

  Units values[64];  ///< kUnknown where unknown
  VoxelBits known;
  /** Voxels with a class record. An octant that is a leaf has one, if any: its first voxel's. */
  VoxelBits recorded;
  std::uint32_t records;     ///< index of the first one's record; the others follow in order
  std::uint8_t leafOctants;  ///< octants that are leaves: their voxels agree

  std::uint8_t knownIn(int octant) const { return octantOf(known, octant); }
  bool isLeafOctant(int octant) const { return leafOctants >> octant & 1; }
  /** The bit of `recorded` that tells of a voxel. */
  int recordBit(int voxel) const { return isLeafOctant(voxel / 8) ? voxel & ~7 : voxel; }
  bool hasRecord(int voxel) const { return recorded >> recordBit(voxel) & 1; }
  int numRecords() const { return countOf(recorded); }
  /** Where a voxel's record stands among the block's. */
  int rankOfRecord(int voxel) const {
    return countOf(recorded & ((VoxelBits(1) << recordBit(voxel)) - 1));
  }
  Units highestValue() const;
  /** Nodes below the block's own; `inner` of them have children. */
  struct Count {
    int nodes, inner;
  };
  Count count() const;
};

/** What a block holds, voxel by voxel: to be written, or read, as a whole. */
struct BlockContent {
  Units values[64];
  VoxelBits known = 0, recorded = 0;
  std::uint8_t leafOctants = 0;
  ClassRecord records[64];  ///< where recorded

  BlockContent() { std::fill(values, values + 64, kUnknown); }
  void setVoxel(int voxel, Units value, const ClassRecord* record);
  void setLeafOctant(int octant, Units value, const ClassRecord* record);
  /** Makes an octant a leaf if its voxels agree. */
  void mergeOctant(int octant);
};

class NodeArena;
class Scan;

/** Class ids; kNoClass is free space. */
using ClassSet = std::bitset<256>;

/** Where the children of nodes are that are away (see MapFolder). */
class TileSource {
 public:
  virtual ~TileSource() = default;
  /** Makes an inner node that is away an octant. Others may go away for it. */
  virtual void bring(Slot& away) = 0;
  /** Makes that of all nodes that a scan is going to change. */
  virtual void prepare(const Scan& scan) = 0;
  /** Makes all nodes go away that may. */
  virtual void sendAway() = 0;
  /** Forgets all nodes. */
  virtual void clear() = 0;
  virtual bool mayChange() const = 0;
  /** Depth of the nodes that go away. */
  virtual int depth() const = 0;
  /** An inner node at that depth has changed, and is as it is to be, with all that is below. Others
   * may go away for it. */
  virtual void changed(const Cube& cell) = 0;
  /** Whether there may be leaves below a node that is away whose half-life is that of one of these.
   */
  virtual bool mayHold(const Slot& away, const ClassSet& classes) const = 0;
  /** \param available bytes of memory; without, those that the system has left
   * \throw std::runtime_error naming the bytes that the map needs as a whole, if these are more */
  virtual void checkFits(std::optional<std::size_t> available) const = 0;
};

/** Memory of a tree: nodes, class records, bookkeeping of inner nodes.
 *
 * How nodes are stored is known here, to what writes them (ScanMerger, TreeBuilder, TreeReader) and
 * to what keeps their bookkeeping (GTree). Everything else reads SemanticOcTreeNode. */
class NodeStore {
 public:
  /** \param stateBytes size of the bookkeeping of an inner node above the blocks, 0 for none. */
  explicit NodeStore(std::size_t stateBytes);
  NodeStore(const NodeStore&) = delete;
  /** What becomes of tiles in a copy. */
  enum class Tiles {
    StayAway,  ///< those that are away are away in the copy, too, which has the same source
    ComeIn     ///< one after the other; the copy is in memory
  };
  /** A copy with room for this bookkeeping (copied if both have the same size). */
  std::unique_ptr<NodeStore> copy(std::size_t stateBytes, Tiles tiles = Tiles::ComeIn) const;

  Slot& root() { return m_root; }
  const Slot& root() const { return m_root; }
  bool empty() const { return !m_root.isKnown(); }
  Node rootNode() const { return empty() ? Node() : Node(*this, m_root); }

  /** The i-th of the arenas, one per thread; made when first asked for (not thread safe). */
  NodeArena& arena(int i);

  Octant& octant(const Slot& inner) const {
    return *reinterpret_cast<Octant*>(m_octants.at(inner.index));
  }
  Block& block(const Slot& inner) const {
    return *reinterpret_cast<Block*>(m_blocks.at(inner.index));
  }
  ClassRecord& record(const Slot& leaf) const { return *recordAt(leaf.index); }
  ClassRecord& record(const Block& block, int voxel) const {
    return recordsOf(block)[block.rankOfRecord(voxel)];
  }
  ClassRecord* recordsOf(const Block& block) const { return recordAt(block.records); }
  BlockContent contentOf(const Block& block) const;
  /** The class record of a leaf that has one. */
  static const ClassRecord& record(const Node& leaf);

  /** Null: all nodes are in memory. */
  TileSource* tiles() const { return m_tiles; }
  void setTiles(TileSource* tiles) { m_tiles = tiles; }
  /** Has the children of a node in memory, if it has any. */
  void bring(const Slot& slot) const {
    if (slot.kind == Slot::Kind::Away) bringAway(slot);
  }
  /** Whoever changes nodes tells it of each that is as it is to be, with all that is below. */
  void tellChanged(const Slot& slot, const Cube& cell) const {
    if (m_tiles && cell.depth == m_tiles->depth() && slot.isInner()) m_tiles->changed(cell);
  }
  /** Counts nodes that went away, or came back (negative). */
  void countAway(long nodes, long inner) {
    m_awayNodes += nodes;
    m_awayInner += inner;
  }
  int numArenas() const { return static_cast<int>(m_arenas.size()); }

  /** Bookkeeping of an inner node that is a slot. */
  template <typename T>
  T* state(const Slot& inner) const {
    return reinterpret_cast<T*>(inner.kind == Slot::Kind::Block
                                    ? m_blocks.at(inner.index) + sizeof(Block)
                                    : m_octants.at(inner.index) + sizeof(Octant));
  }
  std::size_t stateBytes() const { return m_octants.stride() - sizeof(Octant); }
  std::size_t stateBytes(const Slot& inner) const {
    return inner.kind == Slot::Kind::Block ? m_blocks.stride() - sizeof(Block) : stateBytes();
  }
  /** Size of a block's bookkeeping, where there is any. */
  static constexpr std::size_t kBlockStateBytes = 8;
  static const Slot& slotOf(const Node& node) { return *node.m_slot; }
  /** Which of a block's octants an inner node is; -1: it is a slot. */
  static int octantOf(const Node& inner) {
    return inner.isOctant() ? inner.m_part - Node::kFirstOctant : -1;
  }
  /** Log-odds of the most occupied leaf below an inner node, from its children's. */
  Units highestValueBelow(const Slot& inner) const;
  /** Brings an inner node's children and bookkeeping nearer to the processor. */
  void prefetchInner(const Slot& slot) const;

  /** Nobody may read at length (ReadLock) while somebody changes nodes; the second one throws.
   * \throw std::logic_error naming what the other one does. */
  void beginReading() const;
  void endReading() const noexcept { --m_readers; }
  void beginChanging();
  void endChanging() noexcept { m_readers = 0; }

  /** Bytes of nodes, records and bookkeeping in use; what is set aside for more is not counted. */
  std::size_t bytes() const;
  /** What so many nodes would take at the mean of the nodes that are in memory. */
  std::size_t expectedBytes(long nodes) const {
    return bytes() / (numNodes() - static_cast<std::size_t>(m_awayNodes) + 1) *
           static_cast<std::size_t>(nodes);
  }
  /** Nodes including the root, and those that are away. */
  std::size_t numNodes() const;
  std::size_t numInnerNodes() const;

 private:
  friend class NodeArena;
  friend class SemanticOcTreeNode;
  ClassRecord* recordAt(std::uint32_t index) const {
    return reinterpret_cast<ClassRecord*>(m_records.at(index));
  }

  void bringAway(const Slot& slot) const;

  static constexpr int kChanging = -1;

  mutable std::atomic<int> m_readers{0};  ///< or kChanging
  Slot m_root;
  IndexPool m_octants, m_blocks, m_records;
  std::deque<NodeArena> m_arenas;
  TileSource* m_tiles = nullptr;
  long m_awayNodes = 0, m_awayInner = 0;
};

/** One thread's way to create and remove nodes. */
class NodeArena {
 public:
  explicit NodeArena(NodeStore& store) : m_store(&store) {}

  /** Unknown space becomes a leaf. */
  void createLeaf(Slot& slot, Units value);
  /** Unknown space becomes an inner node without children. */
  Octant& createOctant(Slot& slot);
  Block& createBlock(Slot& slot);
  /** The same, as a whole. */
  void createBlock(Slot& slot, const BlockContent& content);
  /** Replaces all that a block holds. */
  void fill(Block& block, const BlockContent& content);
  /** A leaf gets children, each a copy of it. */
  Octant& expandToOctant(Slot& leaf);
  Block& expandToBlock(Slot& leaf);
  /** Turns an inner node into a leaf if its eight children are leaves that agree bit for bit. */
  bool prune(Slot& inner);
  /** Turns a node and all that is below into unknown space. */
  void remove(Slot& known);

  void setRecord(Slot& leaf, const ClassRecord& record);
  void dropRecord(Slot& leaf);
  /** Chooses which voxels have records. Those that stay keep theirs, new ones are not set yet. */
  void setRecorded(Block& block, VoxelBits recorded);
  /** Counts a block's nodes anew. \param before as they were */
  void recount(const Block::Count& before, const Block::Count& after) {
    m_nodes += after.nodes - before.nodes;
    m_inner += after.inner - before.inner;
  }

  /** Made less removed; an arena may remove what another has made. */
  long nodes() const { return m_nodes; }
  long innerNodes() const { return m_inner; }
  /** Blocks that were given back and not taken again. */
  std::size_t spareBlocks() const { return m_blocks.spare(); }

 private:
  friend class NodeStore;
  void copy(const NodeStore& from, const Slot& source, Slot& copy, NodeStore::Tiles tiles);
  void put(const BlockContent& content, Block& block);
  bool pruneOctant(Slot& inner);
  bool pruneBlock(Slot& inner);
  bool childrenAgree(const Octant& octant) const;
  std::uint32_t newOctant();
  std::uint32_t newBlock();
  void becomeInner(Slot& slot, Slot::Kind kind, std::uint32_t index);

  NodeStore* m_store;
  IndexAllocator m_octants, m_blocks, m_records;
  long m_nodes = 0, m_inner = 0;
};

}  // namespace semantic_octree
