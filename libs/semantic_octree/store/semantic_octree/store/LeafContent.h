#pragma once
#include <semantic_octree/store/NodeStore.h>

#include <optional>
#include <vector>

namespace semantic_octree {

/** What a leaf holds. */
struct LeafContent {
  Units value = 0;
  std::optional<ClassRecord> record;

  const ClassRecord* recordOrNull() const { return record ? &*record : nullptr; }
  bool operator==(const LeafContent& o) const { return value == o.value && record == o.record; }
  void write(NodeArena& arena, Slot& unknown) const {
    arena.createLeaf(unknown, value);
    if (record) arena.setRecord(unknown, *record);
  }
};

/** What is stated of p(class k | occupied) of a node, K shares: of the mixture, by volume, of the
 * leaves below in which labels were seen. (Free space and what was hit without a label know nothing
 * of classes; with them, a cell that holds both would state too little.) Empty if there are none.
 */
std::vector<double> classShares(const Node& node, const ClassFilter& filter);

/** What a leaf holds, or an inner node that becomes one: occupancy of its most occupied leaf,
 * classes as they are believed to be. */
LeafContent contentOf(const Node& node, int numClasses);

/** Whose half-life a leaf has: its likeliest class's, or kNoClass if it is free; none: it is
 * occupied, and no class is likelier than the others. */
inline std::optional<ClassId> decaysAs(Units value, const ClassRecord* record, int numClasses) {
  if (value <= 0) return kNoClass;
  if (!record || record->count == 0) return std::nullopt;
  const bool isLikeliest = record->count == numClasses || record->logOdds[0] > record->rest;
  return isLikeliest ? std::optional<ClassId>(record->ids[0]) : std::nullopt;
}
/** decaysAs() of all leaves below an inner node that is in memory with all that is below. */
ClassSet halfLivesBelow(const NodeStore& store, const Slot& inner, int numClasses);

struct ClassLogOdds {
  double logOdds;
  ClassId id;
};

/** Keeps the likeliest named classes. The others join the rest, whose value becomes the logarithm
 * of its members' mean odds.
 * \param rest log-odds of each of the numClasses - named.size() classes that have no name */
Belief truncated(std::vector<ClassLogOdds> named, double rest, int numClasses);

}  // namespace semantic_octree
