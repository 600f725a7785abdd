#include <gtest/gtest.h>
#include <ompl/base/samplers/deterministic/HaltonSequence.h>

#include <algorithm>

#include "roadmap/Candidates.h"

using namespace semantic_planning;

TEST(Halton, pointsAreThoseOfOmplToTheBit) {
  ompl::base::HaltonSequence oracle(4);
  for (unsigned i = 1; i <= 200000; ++i) {
    const std::vector<double> expected = oracle.sample();
    const auto found = haltonPoint(i);
    ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end())) << i;
  }
}
