#include <semantic_octree/store/LeafContent.h>
#include <semantic_octree/store/MapAccess.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

/** \file
 * How a map forgets. At each multiple of T / 8 on the map's clock a leaf with half-life T keeps
 * 2^(-1/8) of its log-odds of occupancy, and of its classes' differences
 * (doc/how-it-works/decay.md).
 *
 * A leaf's half-life is that of its likeliest class, or of free space where it is not occupied. An
 * occupied one without a likeliest class has none. On the grid of log-odds, occupancy is rounded
 * towards 0 and differences away from it: a leaf keeps its half-life until it is unknown. So many
 * short times leave what a long one does, to the last bit. */

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

/** What is left of a leaf after some steps; nothing if its occupancy is within 0.1 of that of
 * unknown space. */
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

/** One sweep through a tree. Nodes are pruned, inner nodes' bookkeeping follows, and it is told
 * where something changed, as in an insertion. */
class Sweep {
 public:
  /** \param steps K + 1 numbers, [0] of free space */
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
    Block& block = m_store.block(slot);
    if (!anyDecays(block)) return false;
    m_nodes.arena.fill(block, decayed(m_store.contentOf(block)));
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

  /** A changed node. A block counts as reshaped. */
  bool finish(Slot& inner, const Cube& cell) { return m_nodes.finish(inner, cell, true, true); }

  NodeEditor m_nodes;
  NodeStore& m_store;
  const ClassFilter& m_filter;
  const std::vector<int>& m_steps;
  ClassSet m_fading;  ///< classes with steps
};

/** Steps of a half-life (seconds) between two times of the map's clock (ns), 0 or more. */
int decaySteps(double halfLife, std::int64_t from, std::int64_t to) {
  if (halfLife == semantic_types::kForever) return 0;
  const std::int64_t step = std::llround(halfLife * 1e9 / kStepsPerHalfLife);
  return static_cast<int>(std::min(kMostSteps, to / step - from / step));
}

}  // namespace

std::int64_t MapAccess::timeIn(const SemanticOcTree& map, double seconds) {
  if (!(seconds >= 0 && seconds <= 1e9))
    throw std::invalid_argument("a map ages by 0 to 1000000000 s, not by " +
                                std::to_string(seconds) + " s");
  if (!map.classes().hasHalfLives()) return map.m_clock;
  const std::int64_t time = map.m_clock + std::llround(seconds * 1e9);
  if (time > kOldest) throw std::out_of_range("a map ages by no more than 200 years in all");
  return time;
}

void MapAccess::ageUntil(SemanticOcTree& map, std::int64_t time) {
  if (time == map.m_clock) return;
  checkMayChange(map);
  std::vector<int> steps;
  for (int id = 0; id <= map.numClasses(); ++id)
    steps.push_back(
        decaySteps(map.classes().halfLife(static_cast<ClassId>(id)), map.m_clock, time));
  map.m_clock = time;  // first, for tiles' files
  if (!map.empty() && std::any_of(steps.begin(), steps.end(), [](int n) { return n > 0; }))
    change(map, [&](const MergeTarget& target) { Sweep(target, steps).decayAll(); });
}

}  // namespace semantic_octree
