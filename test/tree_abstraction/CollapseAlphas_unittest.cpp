#include <gtest/gtest.h>
#include <tree_abstraction/AlphaPath.h>

#include <algorithm>
#include <numeric>

#include "PathExamples.h"

using namespace path_examples;

namespace {

/** Distinct positive taus, ascending. */
std::vector<double> breakpoints(std::vector<double> tau) {
  std::sort(tau.begin(), tau.end());
  tau.erase(std::unique(tau.begin(), tau.end()), tau.end());
  tau.erase(tau.begin(), std::upper_bound(tau.begin(), tau.end(), 0.0));
  return tau;
}

void expectPathEqualsSearch(const Forest& tree, AbstractionWeights weights) {
  weights.alpha = 0;
  const auto tau = tausOf(findOptimalTree(tree, weights), weights);
  std::vector<double> alphas{0.0, 1e-6, 0.01, 0.1, 1.0, 10.0};
  for (const double t : breakpoints(tau)) {
    for (const double factor : {1 - 1e-7, 1.0, 1 + 1e-7}) alphas.push_back(t * factor);
  }
  for (const double alpha : alphas) {
    SCOPED_TRACE(alpha);
    weights.alpha = alpha;
    EXPECT_EQ(expandedAt(tau, alpha, 2 * weights.eps()), findOptimalTree(tree, weights).expanded());
  }
}

/** The optimum by the rule itself: V(i) = gain - alpha price + sum of max(V, 0) below. */
std::vector<char> optimumOf(const std::vector<std::int32_t>& parents,
                            const std::vector<double>& gains, const std::vector<double>& prices,
                            double alpha) {
  const std::size_t n = parents.size();
  std::vector<double> v(n);
  for (std::size_t i = n; i-- > 0;) {
    v[i] += gains[i] - alpha * prices[i];
    if (parents[i] >= 0) v[static_cast<std::size_t>(parents[i])] += std::max(0.0, v[i]);
  }
  std::vector<char> mask(n);
  for (std::size_t i = 0; i < n; ++i) {
    const bool reached = parents[i] < 0 || mask[static_cast<std::size_t>(parents[i])];
    mask[i] = reached && v[i] > 0;
  }
  return mask;
}

}  // namespace

TEST(CollapseAlphas, equalsTheSearchAtEveryAlpha) {
  const Shape shapes[] = {
      {}, {3, 8, 8, 0.4, 0.3}, {3, 4, 4, 0.8, 0.0, 1, 1, true}, {4, 1, 4, 0.6, 0.0, 2, 3}};
  for (const Shape& shape : shapes)
    for (unsigned seed = 1; seed <= 30; ++seed) {
      SCOPED_TRACE(seed);
      Engine random(seed);
      const auto tree = random_trees::makeTree(shape, random);
      expectPathEqualsSearch(tree, random_trees::makeWeights(shape, random));
    }
}

TEST(CollapseAlphas, equalsTheRuleForSmallIntegersWithZerosOfAllKinds) {
  // Gains -3..3 and prices 0..2 are exact, so ties are exact too: compared at every half and third.
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(seed);
    Engine random(seed);
    std::vector<std::int32_t> parents;
    std::vector<double> gains, prices;
    const int n = random_trees::uniformInt(random, 1, 14);
    for (int i = 0; i < n; ++i) {
      parents.push_back(random_trees::uniformInt(random, i < 2 ? -1 : 0, i - 1));
      gains.push_back(random_trees::uniformInt(random, -3, 3));
      prices.push_back(random_trees::uniformInt(random, 0, 2));
    }
    const auto tau = collapseAlphas(parents, gains, prices);
    for (const double alpha : {0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 3.0, 5.0, 1e6}) {
      ASSERT_EQ(expandedAt(tau, alpha), optimumOf(parents, gains, prices, alpha)) << alpha;
    }
  }
}

TEST(CollapseAlphas, infiniteForWhatIsFreeAndNegativeForWhatNeverPays) {
  EXPECT_EQ(collapseAlphas({-1}, {1}, {0}), std::vector<double>{kInfinity});
  EXPECT_EQ(collapseAlphas({-1}, {0}, {0}), std::vector<double>{-kInfinity});
  EXPECT_EQ(collapseAlphas({-1}, {-1}, {0}), std::vector<double>{-kInfinity});
  EXPECT_EQ(collapseAlphas({-1}, {-1}, {2}), std::vector<double>{-0.5});
  EXPECT_EQ(collapseAlphas({-1}, {0}, {2}), std::vector<double>{0.0});
  EXPECT_EQ(collapseAlphas({}, {}, {}), std::vector<double>{});
}

TEST(CollapseAlphas, copesWithALongChain) {
  const std::size_t n = 200000;
  std::vector<std::int32_t> parents(n);
  std::iota(parents.begin(), parents.end(), -1);
  std::vector<double> gains(n, 0.0);
  gains.back() = static_cast<double>(n);
  const auto tau = collapseAlphas(parents, gains, std::vector<double>(n, 1.0));
  for (const double t : tau) ASSERT_EQ(t, 1.0);
}

TEST(CollapseAlphas, copesWithANodeOfManyChildrenInOrder) {
  const std::size_t n = 300000;
  for (const double sign : {1.0, -1.0}) {
    std::vector<std::int32_t> parents(n, 0);
    std::vector<double> gains(n), prices(n, 1.0);
    parents[0] = -1;
    for (std::size_t i = 1; i < n; ++i)
      gains[i] = static_cast<double>(n) + sign * static_cast<double>(i);
    gains[0] = 1e6;
    const auto tau = collapseAlphas(parents, gains, prices);
    for (std::size_t i = 1; i < n; ++i) ASSERT_EQ(tau[i], gains[i]);
  }
}

TEST(CollapseAlphas, rejectsWhatIsNoForest) {
  EXPECT_THROW(collapseAlphas({-1, 0}, {1}, {1, 1}), std::invalid_argument);
  EXPECT_THROW(collapseAlphas({-1, 0}, {1, 1}, {1}), std::invalid_argument);
  EXPECT_THROW(collapseAlphas({0}, {1}, {1}), std::invalid_argument);
  EXPECT_THROW(collapseAlphas({1, -1}, {1, 1}, {1, 1}), std::invalid_argument);
  EXPECT_THROW(collapseAlphas({-2}, {1}, {1}), std::invalid_argument);
  EXPECT_THROW(collapseAlphas({-1}, {kNan}, {1}), std::invalid_argument);
  EXPECT_THROW(collapseAlphas({-1}, {kInfinity}, {1}), std::invalid_argument);
  EXPECT_THROW(collapseAlphas({-1}, {1}, {-1}), std::invalid_argument);
  EXPECT_THROW(collapseAlphas({-1}, {1}, {kNan}), std::invalid_argument);
  EXPECT_THROW(collapseAlphas({-1}, {1}, {kInfinity}), std::invalid_argument);
}
