#include <gtest/gtest.h>
#include <tree_abstraction/AlphaPath.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>

#include "FirstTrees.h"
#include "PathExamples.h"

using namespace path_examples;

namespace {

std::size_t count(const std::vector<char>& mask) {
  return static_cast<std::size_t>(std::count(mask.begin(), mask.end(), char{true}));
}

}  // namespace

TEST(AlphaPath, treesAreNestedAndEachIsTheOptimumAtItsAlpha) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Engine random(seed);
    const Shape shape{3, 8, 8, 0.5};
    const auto tree = random_trees::makeTree(shape, random);
    auto weights = random_trees::makeWeights(shape, random);
    weights.alpha = 0;
    const AlphaPath path(tausOf(findOptimalTree(tree, weights), weights));
    ASSERT_GT(path.numTrees(), 3u);
    EXPECT_EQ(count(path.expanded(0)), 0u);
    EXPECT_EQ(path.highestAlpha(0), kInfinity);
    EXPECT_EQ(path.lowestAlpha(path.numTrees() - 1), 0.0);
    for (std::size_t k = 0; k < path.numTrees(); ++k) {
      EXPECT_LT(path.lowestAlpha(k), path.highestAlpha(k));
      weights.alpha = path.alpha(k);
      EXPECT_EQ(path.expanded(k), findOptimalTree(tree, weights).expanded());
      if (k == 0) continue;
      EXPECT_EQ(path.highestAlpha(k), path.lowestAlpha(k - 1));
      const auto smaller = path.expanded(k - 1), larger = path.expanded(k);
      EXPECT_LT(count(smaller), count(larger));
      for (std::size_t n = 0; n < larger.size(); ++n) EXPECT_LE(smaller[n], larger[n]);
    }
  }
}

TEST(AlphaPath, totalsCountLeavesAndInformationAlongThePath) {
  const Example example(6);
  const AlphaPath path(example.tau);
  const auto leaves = path.totals(addedLeaves(example.found.forest), 1.0);
  const auto entropies = path.totals(example.found.prices(), 0.0);
  for (std::size_t k = 0; k < path.numTrees(); k += 7) {
    const auto measures = measuresOf(example.found, example.weights, path.expanded(k));
    EXPECT_EQ(leaves[k], static_cast<double>(measures.numLeaves));
    EXPECT_NEAR(entropies[k], measures.leafEntropy, 1e-12);
  }
}

TEST(AlphaPath, givesTheLargestTreeWithinAWantedNumberOfLeaves) {
  const Example example(7);
  const AlphaPath path(example.tau);
  const auto added = addedLeaves(example.found.forest);
  const auto leaves = path.totals(added, 1.0);
  const std::size_t all = example.found.full.numLeaves;
  for (std::size_t wanted = 1; wanted <= all; ++wanted) {
    const std::size_t k = path.largestWithin(static_cast<double>(wanted), added, 1);
    EXPECT_LE(leaves[k], static_cast<double>(wanted));
    if (k + 1 < path.numTrees()) {
      EXPECT_GT(leaves[k + 1], static_cast<double>(wanted));
    }
  }
}

TEST(AlphaPath, aBudgetOfBytesMayExceedTheWholeTreeButNotFallBelowTheRoots) {
  const AlphaPath path({3, 2, 2, 1, 0, -1});
  const std::vector<double> bytes{10, 5, 5, 20, 100, 100};
  ASSERT_EQ(path.numTrees(), 4u);
  EXPECT_EQ(path.largestWithin(4, bytes, 4), 0u);
  EXPECT_EQ(path.largestWithin(14, bytes, 4), 1u);
  EXPECT_EQ(path.largestWithin(23, bytes, 4), 1u);  // the two of tau 2 come together
  EXPECT_EQ(path.largestWithin(24, bytes, 4), 2u);
  EXPECT_EQ(path.largestWithin(1e9, bytes, 4), 3u);
  EXPECT_EQ(path.expanded(3), (std::vector<char>{1, 1, 1, 1, 0, 0}));
  EXPECT_THROW(path.largestWithin(3, bytes, 4), std::invalid_argument);
  EXPECT_THROW(path.largestWithin(kNan, bytes, 4), std::invalid_argument);
}

TEST(AlphaPath, rejectsCostsThatDoNotFit) {
  const AlphaPath path({3, 2});
  EXPECT_THROW(path.totals({1}, 0), std::invalid_argument);
  EXPECT_THROW(path.largestWithin(5, {1, -1}, 1), std::invalid_argument);
  EXPECT_THROW(path.largestWithin(5, {1, kNan}, 1), std::invalid_argument);
  EXPECT_THROW(path.largestWithin(1, {1, 1, 1}, 1), std::invalid_argument);
  EXPECT_THROW(path.expanded(3), std::out_of_range);
  EXPECT_THROW(AlphaPath({1, kNan}), std::invalid_argument);
}

TEST(AlphaPath, tausThatDifferByRoundingComeTogether) {
  const AlphaPath path({1.0, 1.0 + 1e-15, 1.0 - 1e-15, 0.5});
  EXPECT_EQ(path.numTrees(), 3u);
  EXPECT_EQ(count(path.expanded(1)), 3u);
}

TEST(AlphaPath, treesThatAreFreeAreOptimalAtEveryFiniteAlpha) {
  const AlphaPath path({kInfinity, 2.0});
  ASSERT_EQ(path.numTrees(), 3u);
  EXPECT_EQ(path.alpha(0), kInfinity);
  EXPECT_EQ(path.lowestAlpha(1), 2.0);
  EXPECT_GT(path.alpha(1), 2.0);
  EXPECT_TRUE(std::isfinite(path.alpha(1)));
  EXPECT_EQ(path.alpha(2), 1.0);
}

TEST(AlphaPath, aTreeThatNeverPaysIsItsRoot) {
  const AlphaPath path({-1.0, -kInfinity});
  EXPECT_EQ(path.numTrees(), 1u);
  EXPECT_GT(path.alpha(0), 0.0);
  EXPECT_EQ(count(path.expanded(0)), 0u);
}

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

using namespace tree_abstraction;

namespace {

/** Many of them agree, some but for rounding, some in chains; some are infinite, 0 or below. */
std::vector<double> someTaus(std::mt19937& random, std::size_t number) {
  std::vector<double> tau;
  while (tau.size() < number) {
    double t =
        std::ldexp(1.0 + static_cast<double>(random() % 16) / 16, static_cast<int>(random() % 4));
    for (int i = static_cast<int>(random() % 4); i >= 0; --i, t *= 1 + 0.7e-12) tau.push_back(t);
    if (random() % 10 == 0) tau.push_back(std::numeric_limits<double>::infinity());
    if (random() % 10 == 0) tau.push_back(-1.0 * static_cast<double>(random() % 2));
  }
  std::shuffle(tau.begin(), tau.end(), random);
  return tau;
}

/** \param share of the nodes that are asked for */
void expectThePathsTrees(const std::vector<double>& tau, double share, std::mt19937& random) {
  const AlphaPath path{std::vector<double>(tau)};
  const auto first = firstTreesOf(path);
  std::vector<double> asked;
  std::map<std::size_t, std::size_t> trees = {{0, 0}};  // and their steps
  for (std::size_t i = 0; i < tau.size(); ++i) {
    if (static_cast<double>(random() % 1000) >= 1000 * share) continue;
    asked.push_back(tau[i]);
    if (first[i] < path.numTrees()) trees[first[i]];
  }
  std::size_t number = 0;
  for (auto& [tree, step] : trees) step = number++;
  const AlphaSteps steps(tau, asked);
  ASSERT_EQ(steps.numSteps(), trees.size() + 1);
  for (const auto& [tree, step] : trees) {
    EXPECT_EQ(steps.alpha(step), path.alpha(tree));
    EXPECT_EQ(steps.highestAlpha(step), path.highestAlpha(tree));
  }
  for (const double t : asked) {
    const auto node = static_cast<std::size_t>(std::find(tau.begin(), tau.end(), t) - tau.begin());
    const bool isExpanded = first[node] < path.numTrees();
    EXPECT_EQ(steps.stepOf(t), isExpanded ? trees.at(first[node]) : steps.numSteps() - 1);
  }
}

}  // namespace

TEST(AlphaSteps, areThePathsTreesInWhichSomeNodesComeIn) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto tau = someTaus(random, 1 + seed % 60);
    for (const double share : {0.0, 0.1, 0.5, 1.0}) expectThePathsTrees(tau, share, random);
  }
}

TEST(AlphaSteps, ofNothingAreTheRootsAlone) {
  const AlphaSteps steps({}, {});
  EXPECT_EQ(steps.numSteps(), 2u);
  EXPECT_EQ(steps.alpha(0), AlphaPath({}).alpha(0));
}
