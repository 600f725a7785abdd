#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <tree_abstraction/AlphaPath.h>

#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "StreamTree.h"

namespace semantic_octree {

/** Parts in the order of their turns, packed: of a leaf not much more is kept than what it says. */
class PartList {
 public:
  /** \param step when it is its turn \param begins see TreeParts */
  void add(const TreePart& part, std::size_t step, bool begins);
  /** By step; those of one step stay in the order in which they were added. */
  void sort();

  std::size_t size() const { return m_entries.size(); }
  TreePart part(std::size_t i) const;
  std::size_t step(std::size_t i) const { return m_entries[i].step; }
  bool begins(std::size_t i) const { return m_entries[i].begins; }

 private:
  static constexpr std::size_t kChunk = 1 << 20, kMostOfPart = 128;  // bytes

  struct Entry {
    std::uint64_t path;  ///< of the part's cell
    std::uint32_t step;
    std::uint32_t chunk, at;  ///< where its leaves are
    std::uint8_t depth, mask;
    bool isOctet, begins;
  };

  std::deque<Entry> m_entries;
  std::vector<ByteWriter> m_chunks;  ///< leaves, one behind the other
};

/** What leads from the map that a receiver has to the compressed tree of another map. */
struct TreeParts {
  /** By step, then depth first. A part's step is that of the alpha path's first tree with it.
   * Leaves at the trees' roots and above are of step 0. It begins something if the tree without it,
   * and what comes behind it, is optimal for some alpha. */
  PartList parts;
  /** Each step has an alpha that leads to its tree, and the alpha at which what it brings is worth
   * its price. The last is the map's own. */
  std::vector<double> alphas, ties;
};
/** Cubes in which a tree may have changed. */
class ChangedCells {
 public:
  explicit ChangedCells(std::vector<CellPath> cells);
  /** Whether a cube holds, or is held by, one of them. */
  bool touch(const CellPath& cell) const;

 private:
  /** Paths of first voxels, from the first to behind the last: in order, apart from each other. */
  std::vector<std::pair<std::uint64_t, std::uint64_t>> m_ranges;
};

/** \param before what the receiver has */
TreeParts partsOfChange(SemanticOcTree& map, const StreamTree& before);
/** What leads to the compressed tree as partsOfChange() does, in one step for all alphas.
 * \param changed elsewhere the tree is what it was before; null: anywhere */
TreeParts unorderedPartsOfChange(SemanticOcTree& map, const StreamTree& before,
                                 const ChangedCells* changed);
/** What tells a receiver who has nothing of a tree. */
TreeParts partsOf(const StreamTree& tree, int rootDepth);

}  // namespace semantic_octree
