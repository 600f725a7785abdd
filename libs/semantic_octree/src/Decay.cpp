#include "Decay.h"

#include <algorithm>
#include <cmath>

namespace semantic_octree {
namespace {

constexpr double kStepsPerHalfLife = 8;
const double kFactor = std::exp2(-1 / kStepsPerHalfLife);
/** 0.1 in units: with less a leaf is as good as unknown, p(occupied) below 0.525. */
constexpr int kForgotten = kUnitsPerLogOdds / 10;
/** After so many, nothing is left of any log-odds. */
constexpr std::int64_t kMostSteps = 100;

int shrunk(int units) { return static_cast<int>(units * kFactor); }
int shrunkAwayFromZero(int units) {
  const double x = units * kFactor;
  return static_cast<int>(units < 0 ? std::floor(x) : std::ceil(x));
}

template <typename F>
int repeated(int steps, int units, const F& f) {
  for (; steps > 0; --steps) units = f(units);
  return units;
}

/** A record with other differences between its classes, and another occupancy.
 * \param shrink of a difference in units, what is left */
template <typename F>
ClassRecord withDifferences(const ClassRecord& record, Units occupancy, int numClasses,
                            const F& shrink) {
  const auto below = [&](Units h) {
    return static_cast<float>(shrink(record.logOdds[0] - h)) / kUnitsPerLogOdds;
  };
  Belief belief = record.belief();
  const float rest = below(record.rest);
  double odds = belief.unnamed(numClasses) * std::exp(-static_cast<double>(rest));
  for (int i = 0; i < belief.count; ++i)
    odds += std::exp(-static_cast<double>(below(record.logOdds[i])));
  const float first = onGrid(fromUnits(occupancy) - std::log(odds));
  for (int i = 0; i < belief.count; ++i) belief.logOdds[i] = first - below(record.logOdds[i]);
  belief.rest = first - rest;
  belief.sort();
  return ClassRecord::of(belief);
}

/** One sweep through a tree. */
class Sweep {
 public:
  Sweep(const MergeTarget& target, const std::vector<int>& steps)
      : m_nodes(target, 0), m_store(target.store), m_filter(target.filter), m_steps(steps) {
    for (std::size_t id = 0; id < steps.size(); ++id) m_fading[id] = steps[id] > 0;
  }

  void decayAll() {
    decay(m_store.root(), Cube());
    m_nodes.tellNoted();
  }

 private:
  /** \return whether anything changed */
  bool decay(Slot& slot, const Cube& cell) {
    const TileSource* const tiles = m_store.tiles();
    if (slot.kind == Slot::Kind::Away && tiles && !tiles->mayHold(slot, m_fading)) return false;
    m_store.bring(slot);
    const bool isTile = cell.depth == kTileDepth || (cell.depth < kTileDepth && slot.isLeaf());
    const bool changed = slot.kind == Slot::Kind::Octant  ? decayChildren(slot, cell)
                         : slot.kind == Slot::Kind::Block ? decayBlock(slot, cell)
                                                          : slot.isKnown() && decayLeaf(slot);
    if (changed) m_store.tellChanged(slot, cell);
    return isTile ? m_nodes.note(cell, changed) : changed;
  }

  int numClasses() const { return m_filter.numClasses(); }
  int stepsOf(Units value, const ClassRecord* record) const {
    const auto id = decaysAs(value, record, numClasses());
    return id ? m_steps[*id] : 0;
  }
  std::optional<LeafContent> decayed(const LeafContent& leaf) const {
    const int steps = stepsOf(leaf.value, leaf.recordOrNull());
    return steps > 0 ? semantic_octree::decayed(leaf, steps, numClasses()) : leaf;
  }

  bool decayLeaf(Slot& slot) {
    const bool hasRecord = slot.kind == Slot::Kind::LeafWithRecord;
    LeafContent before{slot.value, {}};
    if (hasRecord) before.record = m_store.record(slot);
    if (stepsOf(before.value, before.recordOrNull()) == 0) return false;
    const auto after = decayed(before);
    if (!after) {
      m_nodes.arena.remove(slot);
      return true;
    }
    slot.value = after->value;
    if (hasRecord) m_store.record(slot) = *after->record;
    return true;
  }

  bool decayChildren(Slot& slot, const Cube& cell) {
    Octant& octant = m_store.octant(slot);
    bool changed = false;
    for (int i = 0; i < 8; ++i) changed |= decay(octant.slots[i], cell.child(i));
    return changed && finish(slot, cell);
  }

  bool decayBlock(Slot& slot, const Cube& cell) {
    const Block& block = m_store.block(slot);
    if (!anyDecays(block)) return false;
    const BlockContent after = decayed(m_store.contentOf(block));
    m_nodes.arena.remove(slot);
    if (!after.known) return true;
    m_nodes.arena.createBlock(slot, after);
    return finish(slot, cell);
  }

  bool anyDecays(const Block& block) const {
    const ClassRecord* record = block.recorded ? m_store.recordsOf(block) : nullptr;
    for (VoxelBits bits = block.recorded; bits; bits &= bits - 1)
      if (stepsOf(block.values[__builtin_ctzll(bits)], record++) > 0) return true;
    return m_steps[kNoClass] > 0 && std::any_of(block.values, block.values + 64, [](Units value) {
             return value != kUnknown && value <= 0;
           });
  }

  BlockContent decayed(const BlockContent& before) const {
    BlockContent after;
    for (int o = 0; o < 8; ++o) {
      const bool isLeaf = before.leafOctants >> o & 1;
      for (VoxelBits bits = isLeaf ? 1 : octantOf(before.known, o); bits; bits &= bits - 1) {
        const int voxel = 8 * o + __builtin_ctzll(bits);
        LeafContent leaf{before.values[voxel], {}};
        if (before.recorded >> voxel & 1) leaf.record = before.records[voxel];
        const auto left = decayed(leaf);
        if (left && isLeaf) after.setLeafOctant(o, left->value, left->recordOrNull());
        if (left && !isLeaf) after.setVoxel(voxel, left->value, left->recordOrNull());
      }
      if (m_nodes.pruning) after.mergeOctant(o);
    }
    return after;
  }

  /** A changed node. What was told of a block that was replaced is not known: it counts as
   * reshaped. */
  bool finish(Slot& inner, const Cube& cell) { return m_nodes.finish(inner, cell, true, true); }

  NodeEditor m_nodes;
  NodeStore& m_store;
  const ClassFilter<float>& m_filter;
  const std::vector<int>& m_steps;
  ClassSet m_fading;  ///< classes with steps
};

}  // namespace

int decaySteps(double halfLife, std::int64_t from, std::int64_t to) {
  if (halfLife == semantic_types::kForever) return 0;
  const std::int64_t step = std::llround(halfLife * 1e9 / kStepsPerHalfLife);
  return static_cast<int>(std::min(kMostSteps, to / step - from / step));
}

std::optional<LeafContent> decayed(const LeafContent& leaf, int steps, int numClasses) {
  LeafContent left = leaf;
  left.value = static_cast<Units>(repeated(steps, leaf.value, shrunk));
  if (std::abs(left.value) < kForgotten) return std::nullopt;
  if (leaf.record)
    left.record = withDifferences(*leaf.record, left.value, numClasses, [steps](int difference) {
      return repeated(steps, difference, shrunkAwayFromZero);
    });
  return left;
}

void decay(const MergeTarget& target, const std::vector<int>& steps) {
  Sweep(target, steps).decayAll();
}

}  // namespace semantic_octree
