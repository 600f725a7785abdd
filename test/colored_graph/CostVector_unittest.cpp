#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <limits>
#include <vector>

#include "CostVector.h"

using Cost = colored_graph::CostVector;

namespace {

constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();

Cost make(const std::vector<std::int64_t>& parts) {
  Cost cost;
  for (int i = 0; i < 4; ++i) cost[i] = parts[i];
  return cost;
}

/** Few different numbers, so that vectors share their first components; some near the limit. */
std::vector<std::int64_t> parts() {
  return *rc::gen::container<std::vector<std::int64_t>>(
      4, rc::gen::element<std::int64_t>(0, 1, 2, 3, kLargest / 2, kLargest - 1, kLargest));
}

}  // namespace

TEST(CostVector, isStrictlyAndTotallyOrderedLikeASequence) {
  EXPECT_TRUE(rc::check([] {
    const auto l = parts(), r = parts();
    RC_ASSERT((make(l) < make(r)) == (l < r));
    RC_ASSERT((make(l) == make(r)) == (l == r));
    RC_ASSERT((make(l) != make(r)) == (l != r));
  }));
}

TEST(CostVector, addsPartByPartAndOverflowsToInfinity) {
  EXPECT_TRUE(rc::check([] {
    const auto l = parts(), r = parts();
    bool overflows = false;
    std::vector<std::int64_t> sums;
    for (int i = 0; i < 4; ++i) {
      overflows = overflows || l[i] > kLargest - r[i];
      if (!overflows) sums.push_back(l[i] + r[i]);
    }
    const Cost sum = make(l) + make(r);
    RC_ASSERT(sum == (overflows ? Cost::infinite() : make(sums)));
    RC_ASSERT(sum == make(r) + make(l));
    RC_ASSERT(!(sum < make(l)));
  }));
}

TEST(CostVector, infinityIsAboveAllAndStays) {
  const Cost infinite = Cost::infinite();
  EXPECT_TRUE(infinite.isInfinite());
  EXPECT_FALSE(make({kLargest, 0, 0, 0}).isInfinite());
  EXPECT_LT(make({kLargest, kLargest, kLargest, kLargest - 1}), infinite);
  EXPECT_EQ(infinite + Cost(), infinite);
  EXPECT_EQ(infinite + infinite, infinite);
  EXPECT_EQ(infinite + make({0, 0, 0, 1}), infinite);
}
