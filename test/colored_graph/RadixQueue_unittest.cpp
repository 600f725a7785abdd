#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <map>
#include <tuple>

#include "CostVector.h"
#include "PackedCost.h"
#include "RadixQueue.h"

using namespace colored_graph;

namespace {

/** The same number as three kinds of keys. */
PackedCost packed(unsigned high, unsigned low) {
  return PackedCost(Bits128{high} << 70 | Bits128{low} << 3);
}
CostVector<3> vectorOf(unsigned high, unsigned low) {
  CostVector<3> cost;
  cost[0] = high;
  cost[2] = low;
  return cost;
}

/** Entries come out as from a sorted container, whatever is put in between, as long as nothing
 * smaller than the last comes in. */
template <class MakeKey>
void comparesWithASortedMap(MakeKey makeKey) {
  using Key = decltype(makeKey(0, 0));
  RadixQueue<Key> queue;
  using Place = std::tuple<unsigned, unsigned, bool, VertexId, EdgeId>;
  std::map<Place, int> sorted;
  unsigned lastHigh = 0, lastLow = 0;
  for (int turns = *rc::gen::inRange(1, 200); turns > 0; --turns) {
    if (sorted.empty() || *rc::gen::inRange(0, 3) > 0) {
      const unsigned high = lastHigh + *rc::gen::element(0u, 0u, 1u, 70u);
      const unsigned low = *rc::gen::element(0u, 1u, 5u, 1000u) + (high == lastHigh ? lastLow : 0u);
      const VertexId v = *rc::gen::inRange<VertexId>(0, 5);
      const EdgeId e = *rc::gen::element(EdgeId{kNoEdge}, EdgeId{0}, EdgeId{1});
      queue.push({makeKey(high, low), v, e});
      ++sorted[{high, low, e != kNoEdge, v, e}];
    } else {
      const auto entry = queue.pop();
      const auto [high, low, isEdge, v, e] = sorted.begin()->first;
      RC_ASSERT(entry.key == makeKey(high, low));
      RC_ASSERT(entry.vertex == v);
      RC_ASSERT(entry.edge == e);
      if (--sorted.begin()->second == 0) sorted.erase(sorted.begin());
      lastHigh = high;
      lastLow = low;
    }
    RC_ASSERT(queue.empty() == sorted.empty());
  }
}

}  // namespace

TEST(RadixQueue, hasTheOrderOfASortedMapWithPackedKeys) {
  EXPECT_TRUE(rc::check([] { comparesWithASortedMap(packed); }));
}

TEST(RadixQueue, hasTheOrderOfASortedMapWithVectors) {
  EXPECT_TRUE(rc::check([] { comparesWithASortedMap(vectorOf); }));
}

TEST(RadixQueue, takesAKeyBelowTheLastForAnEqualOne) {
  RadixQueue<PackedCost> queue;
  queue.push({packed(1, 0), 7, kNoEdge});
  queue.pop();
  queue.push({packed(2, 0), 8, kNoEdge});
  queue.push({packed(0, 5), 9, kNoEdge});
  EXPECT_EQ(queue.pop().vertex, 9u);
  EXPECT_EQ(queue.pop().vertex, 8u);
  EXPECT_TRUE(queue.empty());
}
