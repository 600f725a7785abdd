#include "StreamTree.h"

#include <semantic_octree/store/TileCodes.h>
#include <semantic_octree/store/TreeBuilder.h>

#include <algorithm>
#include <stdexcept>

namespace semantic_octree {
namespace {

/** A node for TreeBuilder. */
struct StreamCursor {
  Node node;

  bool known() const { return bool(node); }
  bool isLeaf() const { return node.isLeaf(); }
  LeafContent content() const { return contentOf(node, 0); }  // a leaf's needs no classes
  StreamCursor child(int i) const { return {isLeaf() ? node : node.child(i)}; }
};

bool isInnerOctant(const BlockContent& block, int octant) {
  return octantOf(block.known, octant) != 0 && !(block.leafOctants >> octant & 1);
}

void clearOctant(BlockContent& block, int octant) {
  const VoxelBits others = ~(VoxelBits(0xff) << 8 * octant);
  block.known &= others;
  block.recorded &= others;
  block.leafOctants &= static_cast<std::uint8_t>(~(1u << octant));
  std::fill_n(block.values + 8 * octant, 8, kUnknown);
}

/** A leaf octant becomes eight voxels that say the same. */
void splitOctant(BlockContent& block, int octant) {
  const int first = 8 * octant;
  const Units value = block.values[first];
  const ClassRecord record = block.records[first];
  const bool hasRecord = block.recorded >> first & 1;
  block.leafOctants &= static_cast<std::uint8_t>(~(1u << octant));
  for (int i = 0; i < 8; ++i) block.setVoxel(first + i, value, hasRecord ? &record : nullptr);
}

}  // namespace

CellPath CellPath::of(const Cube& cube) {
  return CellPath{tileCode(cube.lowest), kTreeDepth}.above(cube.depth);
}

void put(ByteWriter& to, const StreamLeaf& leaf) {
  const ClassRecord* record = leaf ? leaf->recordOrNull() : nullptr;
  to.value(static_cast<std::uint8_t>(record ? 2 + record->count : leaf.has_value()));
  if (leaf) to.value(leaf->value);
  if (!record) return;
  to.value(record->rest);
  for (int i = 0; i < record->count; ++i) {
    to.value(record->ids[i]);
    to.value(static_cast<Units>(record->logOdds[i] - record->rest));
  }
}

void get(ByteReader& from, StreamLeaf& leaf) {
  leaf.reset();
  const int kind = from.take<std::uint8_t>();
  if (kind > 5) throw std::runtime_error("altered: a leaf that cannot be");
  if (kind > 0) from.value(leaf.emplace().value);
  if (kind < 2) return;
  ClassRecord& record = leaf->record.emplace();
  record = {};
  record.count = static_cast<std::uint8_t>(kind - 2);
  from.value(record.rest);
  for (int i = 0; i < record.count; ++i) {
    from.value(record.ids[i]);
    record.logOdds[i] = static_cast<Units>(record.rest + from.take<Units>());
  }
}

Slot* StreamTree::find(const CellPath& cell) {
  Slot* slot = &m_store->root();
  for (int depth = 1; depth <= std::min(cell.depth, Block::kDepth); ++depth) {
    if (slot->kind != Slot::Kind::Octant) return nullptr;
    slot = &m_store->octant(*slot).slots[cell.childAt(depth)];
  }
  return slot;
}

bool StreamTree::has(const CellPath& cell) {
  const Slot* slot = find(cell);
  if (!slot || cell.depth <= Block::kDepth) return slot && slot->isKnown();
  if (slot->kind != Slot::Kind::Block) return false;
  const Block& block = m_store->block(*slot);
  const int octant = cell.childAt(Block::kDepth + 1);
  if (cell.depth == Block::kDepth + 1) return block.knownIn(octant) != 0;
  return !block.isLeafOctant(octant) && block.knownIn(octant) >> cell.childAt(kTreeDepth) & 1;
}

/** What may fail is done before the slot changes. */
void StreamTree::replace(Slot& slot, Slot by) {
  std::swap(slot, by);
  if (by.isKnown()) arena().remove(by);
}

Slot& StreamTree::makePlace(const CellPath& cell) {
  Slot* slot = &m_store->root();
  for (int depth = 0; depth < cell.depth && depth <= Block::kDepth; ++depth) {
    if (!slot->isInner()) {
      Slot inner = *slot;
      if (depth == Block::kDepth)
        inner.isKnown() ? arena().expandToBlock(inner) : arena().createBlock(inner);
      else
        inner.isKnown() ? arena().expandToOctant(inner) : arena().createOctant(inner);
      *slot = inner;
    }
    if (depth < Block::kDepth) slot = &m_store->octant(*slot).slots[cell.childAt(depth + 1)];
  }
  return *slot;
}

void StreamTree::setLeaf(Slot& slot, const CellPath& cell, const StreamLeaf& leaf) {
  if (slot.isInner() && isNewInner(cell)) return;
  Slot fresh;
  if (leaf) leaf->write(arena(), fresh);
  replace(slot, fresh);
}

void StreamTree::setLeafInBlock(BlockContent& block, const CellPath& cell, const StreamLeaf& leaf) {
  const int octant = cell.childAt(Block::kDepth + 1);
  if (cell.depth == Block::kDepth + 1) {
    if (isInnerOctant(block, octant) && isNewInner(cell)) return;
    clearOctant(block, octant);
    if (leaf) block.setLeafOctant(octant, leaf->value, leaf->recordOrNull());
    return;
  }
  if (block.leafOctants >> octant & 1) splitOctant(block, octant);
  const int voxel = 8 * octant + cell.childAt(kTreeDepth);
  block.known &= ~(VoxelBits(1) << voxel);
  block.recorded &= ~(VoxelBits(1) << voxel);
  block.values[voxel] = kUnknown;
  if (leaf) block.setVoxel(voxel, leaf->value, leaf->recordOrNull());
}

void StreamTree::changeBlock(Slot& slot, const TreePart& part) {
  BlockContent content;
  if (slot.kind == Slot::Kind::Block) content = m_store->contentOf(m_store->block(slot));
  const CellPath& cell = part.cell;
  if (!part.isOctet) {
    setLeafInBlock(content, cell, part.leaves[0]);
  } else {
    if (slot.kind != Slot::Kind::Block) noteInner(cell);
    const int octant = cell.depth > Block::kDepth ? cell.childAt(Block::kDepth + 1) : 0;
    if (cell.depth > Block::kDepth && !isInnerOctant(content, octant)) {
      noteInner(cell);
      clearOctant(content, octant);
    }
    for (int i = 0; i < 8; ++i)
      if (part.mask >> i & 1) setLeafInBlock(content, cell.child(i), part.leaves[i]);
  }
  Slot fresh;
  if (content.known) arena().createBlock(fresh, content);
  replace(slot, fresh);
}

void StreamTree::setChildren(Slot& inner, const TreePart& octet) {
  if (inner.kind != Slot::Kind::Octant) {
    noteInner(octet.cell);
    Slot fresh;
    arena().createOctant(fresh);
    replace(inner, fresh);
  }
  for (int i = 0; i < 8; ++i)
    if (octet.mask >> i & 1)
      setLeaf(m_store->octant(inner).slots[i], octet.cell.child(i), octet.leaves[i]);
}

bool StreamTree::apply(const TreePart& part, std::uint32_t revision) {
  if (revision != m_revision) m_newInner.clear();
  m_revision = revision;
  if (part.isOctet && !has(part.cell)) return false;
  Slot& slot = part.isOctet ? *find(part.cell) : makePlace(part.cell);
  if (part.cell.depth > Block::kDepth || (part.isOctet && part.cell.depth == Block::kDepth))
    changeBlock(slot, part);
  else if (part.isOctet)
    setChildren(slot, part);
  else
    setLeaf(slot, part.cell, part.leaves[0]);
  return true;
}

SemanticOcTree StreamTree::map(const SemanticOcTree& empty) const {
  SemanticOcTree map(empty);
  if (!m_store->empty())
    TreeBuilder::fill(map, StreamCursor{m_store->rootNode()}, TreeBuilder::Merge::Never);
  return map;
}

}  // namespace semantic_octree
