#pragma once
#include <semantic_octree/store/LeafContent.h>
#include <semantic_octree/store/MapAccess.h>

#include <cstdint>
#include <limits>
#include <stdexcept>

namespace semantic_octree {

/** Fills an empty map from the top.
 *
 * A cursor stands for a cube of the new map. `bool known()` is asked first: whether anything may be
 * known in it. `bool isLeaf()` says whether all of it is alike, `LeafContent content()` then how.
 * `Cursor child(int i)` must also work for cubes that are leaves. */
class TreeBuilder {
 public:
  /** Children that agree. */
  enum class Merge { AsTheMapDoes, Never };

  /** A map in a folder of tiles that is open for writing sends tiles away meanwhile.
   * \param mostCubes that get children \throw std::length_error the new map would have more */
  template <typename Cursor>
  static void fill(SemanticOcTree& map, const Cursor& root, Merge merge = Merge::AsTheMapDoes,
                   std::uint64_t mostCubes = std::numeric_limits<std::uint64_t>::max()) {
    MapAccess::checkMayChange(map);
    MapAccess::tellAll(map);
    NodeStore& store = MapAccess::store(map);
    TreeBuilder(store, map.pruning(), merge, mostCubes).build(store.root(), root, Cube());
  }
  /** \throw std::invalid_argument a map that is to be filled is not empty, keeps an abstraction, or
   * is of another kind than `like`. */
  static void checkTarget(const SemanticOcTree& map, const SemanticOcTree& like) {
    if (!map.empty() || MapAccess::observer(map) || emptyLike(map) != emptyLike(like))
      throw std::invalid_argument(
          "a map that is to be filled has to be empty, of the same kind, without abstraction");
  }

 private:
  TreeBuilder(NodeStore& store, bool pruning, Merge merge, std::uint64_t mostCubes)
      : m_store(store),
        m_arena(store.arena(0)),
        m_allowsLargeLeaves(pruning),
        m_merges(pruning && merge == Merge::AsTheMapDoes),
        m_cubesLeft(mostCubes) {}

  template <typename Cursor>
  void build(Slot& slot, const Cursor& cursor, const Cube& cell) {
    if (!cursor.known()) return;
    if (cursor.isLeaf() && m_allowsLargeLeaves)
      cursor.content().write(m_arena, slot);
    else if (m_cubesLeft-- == 0)
      throw std::length_error(
          "leaves are so large that cutting them makes too many: use coarser voxels");
    else if (cell.depth == Block::kDepth)
      buildBlock(slot, cursor);
    else
      buildChildren(slot, cursor, cell);
    m_store.tellChanged(slot, cell);
  }

  template <typename Cursor>
  void buildChildren(Slot& slot, const Cursor& cursor, const Cube& cell) {
    Octant& octant = m_arena.createOctant(slot);
    Units highest = kUnknown;
    for (int i = 0; i < 8; ++i) {
      build(octant.slots[i], cursor.child(i), cell.child(i));
      if (octant.slots[i].isKnown()) highest = std::max(highest, octant.slots[i].value);
    }
    if (highest == kUnknown)
      m_arena.remove(slot);
    else if (!(m_merges && m_arena.prune(slot)))
      slot.value = highest;
  }

  template <typename Cursor>
  void buildBlock(Slot& slot, const Cursor& cursor) {
    BlockContent content;
    for (int o = 0; o < 8; ++o) buildOctant(content, o, cursor.child(o));
    if (!content.known) return;
    m_arena.createBlock(slot, content);
    if (m_merges) m_arena.prune(slot);
  }

  template <typename Cursor>
  void buildOctant(BlockContent& content, int octant, const Cursor& cursor) {
    if (!cursor.known()) return;
    if (cursor.isLeaf() && m_allowsLargeLeaves) {
      const LeafContent leaf = cursor.content();
      return content.setLeafOctant(octant, leaf.value, leaf.recordOrNull());
    }
    for (int i = 0; i < 8; ++i) {
      const Cursor voxel = cursor.child(i);
      if (!voxel.known()) continue;
      const LeafContent leaf = voxel.content();
      content.setVoxel(8 * octant + i, leaf.value, leaf.recordOrNull());
    }
    if (m_merges) content.mergeOctant(octant);
  }

  NodeStore& m_store;
  NodeArena& m_arena;
  bool m_allowsLargeLeaves, m_merges;
  std::uint64_t m_cubesLeft;
};

}  // namespace semantic_octree
