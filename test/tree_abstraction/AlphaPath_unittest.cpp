#include <gtest/gtest.h>
#include <reference/GTreeSearch.h>
#include <tree_abstraction/AlphaPath.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

#include "RandomTrees.h"

using namespace tree_abstraction;
using namespace reference;
using random_trees::Engine;
using random_trees::Shape;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> tausOf(const SearchResult& found, const AbstractionWeights& weights) {
  return collapseAlphas(found.parents(), found.gains(weights), found.prices());
}

/** Nodes the compressed tree of one alpha expands. \param eps what counts as a tie */
std::vector<char> expandedAt(const std::vector<double>& tau, double alpha, double eps = 0) {
  std::vector<char> mask;
  for (const double t : tau) mask.push_back(t > alpha + eps);
  return mask;
}

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

/** Taus of what comes in together, the largest first; each group falls. */
std::vector<std::vector<double>> groupsOf(std::vector<double> tau) {
  std::sort(tau.begin(), tau.end(), std::greater<>());
  std::vector<std::vector<double>> groups;
  double before = kNan;
  for (const double t : tau) {
    if (!(t > 0)) break;
    if (groups.empty() || !isTie(before, t)) groups.emplace_back();
    groups.back().push_back(before = t);
  }
  return groups;
}

/** \param share of the nodes that are asked for */
void expectTreesOfGroups(const std::vector<double>& tau, double share, std::mt19937& random) {
  std::vector<double> asked;
  for (const double t : tau)
    if (static_cast<double>(random() % 1000) < 1000 * share) asked.push_back(t);
  const AlphaPath path(tau, asked);
  const auto groups = groupsOf(tau);
  std::size_t tree = 0;
  EXPECT_EQ(path.highestAlpha(0), kInfinity);
  EXPECT_EQ(path.lowestAlpha(0), groups.empty() ? 0 : groups[0][0]);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto isHere = [&](double t) {
      return std::find(groups[g].begin(), groups[g].end(), t) != groups[g].end();
    };
    if (std::none_of(asked.begin(), asked.end(), isHere)) continue;
    ++tree;
    for (const double t : groups[g]) EXPECT_EQ(path.treeOf(t), tree);
    EXPECT_EQ(path.highestAlpha(tree), groups[g].back());
    EXPECT_EQ(path.lowestAlpha(tree), g + 1 < groups.size() ? groups[g + 1][0] : 0);
  }
  EXPECT_EQ(path.numTrees(), tree + 1);
  for (std::size_t k = 0; k <= tree; ++k) {
    EXPECT_GT(path.alpha(k), path.lowestAlpha(k) == kInfinity ? 0 : path.lowestAlpha(k));
    EXPECT_TRUE(path.alpha(k) < path.highestAlpha(k) || path.lowestAlpha(k) == kInfinity);
  }
  for (const double t : {0.0, -1.0}) EXPECT_EQ(path.treeOf(t), tree + 1);
}

}  // namespace

TEST(AlphaPath, hasTheTreesInWhichNodesComeInThatAreAskedFor) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto tau = someTaus(random, seed % 60);
    for (const double share : {0.0, 0.1, 0.5, 1.0}) expectTreesOfGroups(tau, share, random);
  }
}
