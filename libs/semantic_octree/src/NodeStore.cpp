#include <semantic_octree/store/NodeStore.h>

#include <algorithm>
#include <stdexcept>

namespace semantic_octree {

using Kind = Slot::Kind;

NodeStore::NodeStore(std::size_t stateBytes)
    : m_octants(sizeof(Octant) + stateBytes),
      m_blocks(sizeof(Block) + (stateBytes > 0 ? kBlockStateBytes : 0)),
      m_records(sizeof(ClassRecord)) {}

std::unique_ptr<NodeStore> NodeStore::copy(std::size_t stateBytes, Tiles tiles) const {
  auto copy = std::make_unique<NodeStore>(stateBytes);
  copy->arena(0).copy(*this, m_root, copy->m_root, tiles);
  if (tiles == Tiles::ComeIn) return copy;
  copy->m_tiles = m_tiles;
  copy->m_awayNodes = m_awayNodes;
  copy->m_awayInner = m_awayInner;
  return copy;
}

NodeArena& NodeStore::arena(int i) {
  while (static_cast<int>(m_arenas.size()) <= i) m_arenas.emplace_back(*this);
  return m_arenas[i];
}

BlockContent NodeStore::contentOf(const Block& block) const {
  BlockContent content;
  std::copy_n(block.values, 64, content.values);
  content.known = block.known;
  content.recorded = block.recorded;
  content.leafOctants = block.leafOctants;
  const ClassRecord* record = block.recorded ? recordsOf(block) : nullptr;
  for (VoxelBits bits = block.recorded; bits; bits &= bits - 1)
    content.records[__builtin_ctzll(bits)] = *record++;
  return content;
}

const ClassRecord& NodeStore::record(const Node& leaf) {
  const NodeStore& store = *leaf.m_store;
  const Slot& slot = slotOf(leaf);
  if (leaf.m_part == Node::kWhole) return store.record(slot);
  const int voxel =
      leaf.isOctant() ? 8 * (leaf.m_part - Node::kFirstOctant) : leaf.m_part - Node::kFirstVoxel;
  return store.record(store.block(slot), voxel);
}

void NodeStore::bringAway(const Slot& slot) const {
  if (!m_tiles) throw std::logic_error("the map's folder of tiles was closed before the map");
  m_tiles->bring(const_cast<Slot&>(slot));  // the map stays what it is
}

Units NodeStore::highestValueBelow(const Slot& inner) const {
  if (inner.kind == Kind::Block) return block(inner).highestValue();
  Units highest = kUnknown;
  for (const Slot& child : octant(inner).slots)
    if (child.isKnown()) highest = std::max(highest, child.value);
  return highest;
}

void NodeStore::prefetchInner(const Slot& slot) const {
  if (!slot.isInner()) return;
  const bool isBlock = slot.kind == Kind::Block;
  const std::byte* begin = isBlock ? m_blocks.at(slot.index) : m_octants.at(slot.index);
  const std::size_t bytes = isBlock ? m_blocks.stride() : m_octants.stride();
  for (std::size_t i = 0; i < bytes; i += 64) __builtin_prefetch(begin + i);
}

std::size_t NodeStore::bytes() const {
  long octants = 0, blocks = 0, records = 0;
  for (const NodeArena& arena : m_arenas) {
    octants += arena.m_octants.inUse();
    blocks += arena.m_blocks.inUse();
    records += arena.m_records.inUse();
  }
  return octants * m_octants.stride() + blocks * m_blocks.stride() + records * m_records.stride();
}

std::size_t NodeStore::numNodes() const {
  long n = m_awayNodes;
  for (const NodeArena& arena : m_arenas) n += arena.nodes();
  return static_cast<std::size_t>(n);
}

std::size_t NodeStore::numInnerNodes() const {
  long n = m_awayInner;
  for (const NodeArena& arena : m_arenas) n += arena.innerNodes();
  return static_cast<std::size_t>(n);
}

std::uint32_t NodeArena::newOctant() {
  const std::uint32_t index = m_octants.allocate(m_store->m_octants);
  std::byte* memory = m_store->m_octants.at(index);
  std::fill_n(memory, m_store->m_octants.stride(), std::byte(0));
  return index;
}

std::uint32_t NodeArena::newBlock() {
  const std::uint32_t index = m_blocks.allocate(m_store->m_blocks);
  std::byte* memory = m_store->m_blocks.at(index);
  std::fill_n(memory, m_store->m_blocks.stride(), std::byte(0));
  Block& block = *reinterpret_cast<Block*>(memory);
  std::fill_n(block.values, 64, kUnknown);
  return index;
}

void NodeArena::becomeInner(Slot& slot, Kind kind, std::uint32_t index) {
  m_nodes += !slot.isKnown();
  ++m_inner;
  slot.kind = kind;
  slot.index = index;
}

void NodeArena::createLeaf(Slot& slot, Units value) {
  ++m_nodes;
  slot.kind = Kind::Leaf;
  slot.value = value;
}

Octant& NodeArena::createOctant(Slot& slot) {
  becomeInner(slot, Kind::Octant, newOctant());
  return m_store->octant(slot);
}

Block& NodeArena::createBlock(Slot& slot) {
  becomeInner(slot, Kind::Block, newBlock());
  return m_store->block(slot);
}

void NodeArena::createBlock(Slot& slot, const BlockContent& content) {
  Block& block = createBlock(slot);
  put(content, block);
  recount({0, 0}, block.count());
  slot.value = block.highestValue();
}

void NodeArena::fill(Block& block, const BlockContent& content) {
  const Block::Count before = block.count();
  put(content, block);
  recount(before, block.count());
}

void NodeArena::put(const BlockContent& content, Block& block) {
  setRecorded(block, content.recorded);  // first, for it may fail
  std::copy_n(content.values, 64, block.values);
  block.known = content.known;
  block.leafOctants = content.leafOctants;
  ClassRecord* record = content.recorded ? m_store->recordsOf(block) : nullptr;
  for (VoxelBits bits = content.recorded; bits; bits &= bits - 1)
    *record++ = content.records[__builtin_ctzll(bits)];
}

Octant& NodeArena::expandToOctant(Slot& leaf) {
  const Slot whole = leaf;
  Octant& octant = createOctant(leaf);
  for (Slot& child : octant.slots) {
    createLeaf(child, whole.value);
    if (whole.kind == Kind::LeafWithRecord) setRecord(child, m_store->record(whole));
  }
  if (whole.kind == Kind::LeafWithRecord) m_records.release(whole.index, 1);
  return octant;
}

Block& NodeArena::expandToBlock(Slot& leaf) {
  const Slot whole = leaf;
  Block& block = createBlock(leaf);
  std::fill_n(block.values, 64, whole.value);
  block.known = ~VoxelBits(0);
  block.leafOctants = 0xff;
  if (whole.kind == Kind::LeafWithRecord) {
    setRecorded(block, 0x0101010101010101);
    std::fill_n(m_store->recordsOf(block), 8, m_store->record(whole));
    m_records.release(whole.index, 1);
  }
  recount({0, 0}, block.count());
  return block;
}

void NodeArena::remove(Slot& known) {
  if (known.kind == Kind::LeafWithRecord) dropRecord(known);
  if (known.kind == Kind::Octant) {
    for (Slot& child : m_store->octant(known).slots)
      if (child.isKnown()) remove(child);
    m_octants.release(known.index);
  } else if (known.kind == Kind::Block) {
    Block& block = m_store->block(known);
    setRecorded(block, 0);
    recount(block.count(), {0, 0});
    m_blocks.release(known.index);
  }
  m_inner -= known.isInner();
  --m_nodes;
  known = Slot();
}

void NodeArena::copy(const NodeStore& from, const Slot& source, Slot& copy,
                     NodeStore::Tiles tiles) {
  if (tiles == NodeStore::Tiles::ComeIn) from.bring(source);
  if (source.isLeaf()) {
    createLeaf(copy, source.value);
    if (source.kind == Kind::LeafWithRecord) setRecord(copy, from.record(source));
  } else if (source.kind == Kind::Block) {
    createBlock(copy, from.contentOf(from.block(source)));
  } else if (source.isInner()) {
    Octant& octant = createOctant(copy);
    copy.value = source.value;
    copy.kind = source.kind;
    const Octant& children = from.octant(source);
    if (source.kind == Kind::Away) octant = children;
    for (int i = 0; i < 8 && source.kind == Kind::Octant; ++i)
      this->copy(from, children.slots[i], octant.slots[i], tiles);
  }
  if (source.isInner() && from.stateBytes() == m_store->stateBytes())
    std::copy_n(from.state<std::byte>(source), from.stateBytes(source),
                m_store->state<std::byte>(copy));
}

bool NodeArena::prune(Slot& inner) {
  return inner.kind == Kind::Block ? pruneBlock(inner) : pruneOctant(inner);
}

bool NodeArena::childrenAgree(const Octant& octant) const {
  const Slot& first = octant.slots[0];
  if (!first.isLeaf()) return false;
  return std::all_of(octant.slots + 1, octant.slots + 8, [&](const Slot& child) {
    return child.kind == first.kind && child.value == first.value &&
           (child.kind == Kind::Leaf || m_store->record(child) == m_store->record(first));
  });
}

bool NodeArena::pruneOctant(Slot& inner) {
  const Octant& octant = m_store->octant(inner);
  if (!childrenAgree(octant)) return false;
  const Slot first = octant.slots[0];
  if (first.kind == Kind::LeafWithRecord)
    for (int i = 1; i < 8; ++i) m_records.release(octant.slots[i].index, 1);
  m_octants.release(inner.index);
  inner = first;
  --m_inner;
  m_nodes -= 8;
  return true;
}

bool NodeArena::pruneBlock(Slot& inner) {
  Block& block = m_store->block(inner);
  if (block.leafOctants != 0xff || (block.recorded && block.numRecords() < 8)) return false;
  if (!std::all_of(block.values, block.values + 64,
                   [&](Units value) { return value == block.values[0]; }))
    return false;
  const ClassRecord* records = block.recorded ? m_store->recordsOf(block) : nullptr;
  if (records &&
      !std::all_of(records, records + 8, [&](const ClassRecord& r) { return r == records[0]; }))
    return false;
  Slot leaf;
  leaf.kind = Kind::Leaf;
  leaf.value = block.values[0];
  if (records) setRecord(leaf, records[0]);
  setRecorded(block, 0);
  m_blocks.release(inner.index);
  inner = leaf;
  --m_inner;
  m_nodes -= 8;
  return true;
}

void NodeArena::setRecord(Slot& leaf, const ClassRecord& record) {
  if (leaf.kind != Kind::LeafWithRecord) {
    leaf.index = m_records.allocate(m_store->m_records, 1);
    leaf.kind = Kind::LeafWithRecord;
  }
  m_store->record(leaf) = record;
}

void NodeArena::dropRecord(Slot& leaf) {
  m_records.release(leaf.index, 1);
  leaf.kind = Kind::Leaf;
}

void NodeArena::setRecorded(Block& block, VoxelBits recorded) {
  if (recorded == block.recorded) return;
  ClassRecord old[64];
  const int before = block.numRecords(), after = countOf(recorded);
  if (before > 0) std::copy_n(m_store->recordsOf(block), before, old);
  if (before == 0 || after == 0 || !IndexAllocator::sameLength(before, after)) {
    if (before > 0) m_records.release(block.records, before);
    if (after > 0) block.records = m_records.allocate(m_store->m_records, after);
  }
  const ClassRecord* from = old;
  ClassRecord* to = after > 0 ? m_store->recordsOf(block) : nullptr;
  for (VoxelBits bits = block.recorded | recorded; bits; bits &= bits - 1) {
    const VoxelBits bit = bits & -bits;
    if (block.recorded & recorded & bit) *to = *from;
    from += (block.recorded & bit) != 0;
    to += (recorded & bit) != 0;
  }
  block.recorded = recorded;
}

void NodeStore::beginReading() const {
  int readers = m_readers;
  do {
    if (readers == kChanging)
      throw std::logic_error("the map is read while another thread changes it");
  } while (!m_readers.compare_exchange_weak(readers, readers + 1));
}

void NodeStore::beginChanging() {
  int readers = 0;
  if (m_readers.compare_exchange_strong(readers, kChanging)) return;
  throw std::logic_error(readers == kChanging ? "two threads change the map at once"
                                              : "the map changes while another thread reads it");
}

}  // namespace semantic_octree
