#pragma once
#include <semantic_octree/store/NodeStore.h>

#include <memory>

namespace semantic_octree {

/** Keeps something of each inner node of a map (see NodeStore::state()), which follows from what is
 * below alone. Whatever changes nodes has it computed anew, from the leaves up.
 *
 * The map owns it. A new node's bytes are 0. */
class NodeObserver {
 public:
  /** One thread's part. */
  class Worker {
   public:
    virtual ~Worker() = default;
    /** Computes what is kept of an inner node that is a slot. \param reshaped whether a block's
     * voxels or octants are not those that were known, or leaves, before */
    virtual void recompute(NodeStore& store, Slot& inner, const Cube& cell, bool reshaped) = 0;
  };

  virtual ~NodeObserver() = default;
  /** Room that it needs in an inner node above the blocks; always the same, and more than 0. In a
   * block it has NodeStore::kBlockStateBytes. */
  virtual std::size_t stateBytes() const = 0;
  /** The i-th thread's; made when first asked for (not thread safe). */
  virtual Worker& worker(int i) = 0;
  /** Whether the same is kept of two maps' nodes, whose observers are of the same type and need as
   * much room. */
  virtual bool sameState(const NodeStore& a, const Slot& inA, const NodeStore& b,
                         const Slot& inB) const = 0;
  /** The map has other nodes: whoever is told of changes is told everything next. */
  virtual void tellAll() = 0;
  /** For a copy of the map. */
  virtual std::unique_ptr<NodeObserver> clone() const = 0;
};

/** Whether two nodes of two trees are the same, and all that is below. \param observer of both,
 * whose bookkeeping counts; null: it does not */
bool areSame(const NodeStore& a, const Slot& inA, const NodeStore& b, const Slot& inB,
             const NodeObserver* observer);

/** Has it all computed, of a node and all inner nodes below. */
void recomputeAll(NodeObserver::Worker& worker, NodeStore& store, Slot& slot, const Cube& cell);

}  // namespace semantic_octree
