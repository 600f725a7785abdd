#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <reference/Divergence.h>
#include <tree_abstraction/AbstractionWeights.h>

#include <cmath>
#include <cstdlib>
#include <numeric>

#include "RandomTrees.h"

using namespace tree_abstraction;
using namespace reference;

namespace {

/** RapidCheck draws the same cases in every run. */
const int kSeedIsFixed = setenv("RC_PARAMS", "seed=20240517", 0);

/** Children with their shares: n rows of `outcomes` probabilities. */
struct Children {
  std::size_t n, outcomes;
  std::vector<double> pi, rows;

  double stable() const { return jensenShannon(pi.data(), rows.data(), n, outcomes, outcomes); }
  std::vector<double> mixed() const {
    std::vector<double> q(outcomes);
    mixRows(pi.data(), rows.data(), n, outcomes, q.data());
    return q;
  }
  double fast() const {
    std::vector<double> h;
    for (std::size_t i = 0; i < n; ++i) h.push_back(entropy(rows.data() + i * outcomes, outcomes));
    return entropyDrop(entropy(mixed().data(), outcomes), pi.data(), h.data(), n);
  }
};

Children makeChildren(std::size_t n, std::size_t outcomes, unsigned seed) {
  random_trees::Engine random(seed);
  Children c{n, outcomes, random_trees::makeDistribution(n, random), {}};
  for (std::size_t i = 0; i < n; ++i) {
    const auto p = random_trees::makeDistribution(outcomes, random);
    c.rows.insert(c.rows.end(), p.begin(), p.end());
  }
  return c;
}

Children drawChildren(std::size_t atLeast = 1) {
  const auto n = *rc::gen::inRange<std::size_t>(atLeast, 10);
  const auto outcomes = *rc::gen::inRange<std::size_t>(2, 7);
  return makeChildren(n, outcomes, *rc::gen::arbitrary<unsigned>());
}

}  // namespace

TEST(Information, entropyIsZeroForCertaintyAndLargestForEqualOutcomes) {
  EXPECT_EQ(binaryEntropy(0.0), 0.0);
  EXPECT_EQ(binaryEntropy(1.0), 0.0);
  EXPECT_FALSE(std::signbit(binaryEntropy(1.0)));
  EXPECT_NEAR(binaryEntropy(0.5), kLn2, 1e-15);
  EXPECT_NEAR(entropy(Eigen::VectorXd::Constant(5, 0.2)), std::log(5.0), 1e-15);
  EXPECT_EQ(entropy(Eigen::Vector3d(0, 1, 0)), 0.0);
}

TEST(Information, entropyAgreesWithItsBinaryForm) {
  for (double p = 0; p <= 1; p += 0.0625) {
    EXPECT_NEAR(entropy(Eigen::Vector2d(p, 1 - p)), binaryEntropy(p), 1e-15);
  }
}

TEST(Information, pairwiseSumOfEightAddsByHalves) {
  const double v[] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
  const auto sum = [&](std::size_t n) {
    return pairwiseSum(n, [&](std::size_t i) { return v[i]; });
  };
  EXPECT_EQ(sum(8), ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7])));
  EXPECT_EQ(sum(0), 0.0);
  EXPECT_EQ(sum(1), v[0]);
  EXPECT_NEAR(sum(7), 2.8, 1e-15);
}

TEST(Information, eightEqualChildrenMixToExactlyTheChild) {
  const double p = 0.1 / 3.0;
  const std::vector<double> pi(8, 0.125), rows(16, p), h(8, binaryEntropy(p));
  double out[2];
  mixRows(pi.data(), rows.data(), 8, 2, out);
  EXPECT_EQ(out[0], p);
  EXPECT_EQ(out[1], p);
  EXPECT_EQ(entropyDrop(binaryEntropy(p), pi.data(), h.data(), 8), 0.0);
}

TEST(Information, phiFollowsItsDefinitionAndItsSeriesAcrossTheSwitch) {
  EXPECT_EQ(phi(-1.0), 1.0);
  EXPECT_EQ(phi(0.0), 0.0);
  for (const double t : {-0.9, -0.3, 0.5, 2.0, 100.0}) {
    EXPECT_NEAR(phi(t), (1 + t) * std::log(1 + t) - t, 1e-14 * (1 + t * t));
  }
  for (const double t : {-0.02, 0.02}) {
    const double inside = phi(t * (1 - 1e-15)), outside = phi(t);
    EXPECT_NEAR(inside, outside, 1e-13 * outside);
  }
  for (const double t : {-1e-3, -1e-9, 1e-12, 1e-6}) {
    const long double x = t;
    const long double series = x * x / 2 - x * x * x / 6 + x * x * x * x / 12 -
                               x * x * x * x * x / 20 + x * x * x * x * x * x / 30;
    EXPECT_NEAR(phi(t) / static_cast<double>(series), 1.0, 1e-14);
  }
}

TEST(Information, stableFormAgreesWithTheEntropyForm) {
  EXPECT_TRUE(rc::check([] {
    const auto c = drawChildren();
    RC_ASSERT(std::abs(c.stable() - c.fast()) < 1e-14);
  }));
}

TEST(Information, stableFormKeepsItsPrecisionWhereTheEntropyFormIsNoise) {
  // Half p + d, half p - d: JS = d^2 / (2 p (1 - p)) up to order d^4.
  const double d = std::ldexp(1.0, -30), p = 0.25;
  const double pi[] = {0.5, 0.5}, children[] = {p + d, p - d};
  const double expected = d * d / (2 * p * (1 - p));
  EXPECT_NEAR(binaryJensenShannon(pi, children, 2), expected, 1e-14 * expected);
  const double rows[] = {p + d, 1 - (p + d), p - d, 1 - (p - d)};
  EXPECT_NEAR(jensenShannon(pi, rows, 2, 2, 2), expected, 1e-12 * expected);
}

TEST(Information, binaryFormEqualsTwoOutcomes) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const auto c = makeChildren(1 + seed % 9, 2, seed);
    EXPECT_NEAR(binaryJensenShannon(c.pi.data(), c.rows.data(), c.n, 2), c.stable(), 1e-14);
  }
}

TEST(Information, equalChildrenDivergeByExactlyNothingWhateverTheirShares) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    auto c = makeChildren(2 + seed % 7, 3, seed);
    for (std::size_t i = 3; i < c.rows.size(); ++i) c.rows[i] = c.rows[i - 3];
    EXPECT_EQ(c.stable(), 0.0);
    EXPECT_EQ(binaryJensenShannon(c.pi.data(), c.rows.data(), c.n, 3), 0.0);
    EXPECT_TRUE(allEqual(c.pi.data(), c.rows.data(), c.n, 3, 3));
  }
}

TEST(Information, aChildWithoutShareCountsNowhere) {
  const double pi[] = {0.25, 0.0, 0.75}, with[] = {0.2, 0.9, 0.6};
  const double piWithout[] = {0.25, 0.75}, without[] = {0.2, 0.6};
  EXPECT_NEAR(binaryJensenShannon(pi, with, 3), binaryJensenShannon(piWithout, without, 2), 1e-16);
  const double equalButOne[] = {0.2, 0.9, 0.2};
  EXPECT_TRUE(allEqual(pi, equalButOne, 3, 1, 1));
  EXPECT_EQ(binaryJensenShannon(pi, equalButOne, 3), 0.0);
}

TEST(Information, fastFormIsNeverNegative) {
  const double pi[] = {1.0}, h[] = {0.5};
  EXPECT_EQ(entropyDrop(0.5 - 1e-16, pi, h, 1), 0.0);
}

TEST(Information, divergenceIsBoundedByTheVariableAndByTheSplit) {
  EXPECT_TRUE(rc::check([] {
    const auto c = drawChildren();
    RC_ASSERT(c.stable() >= 0.0);
    RC_ASSERT(c.stable() <= entropy(c.pi.data(), c.n) + 1e-15);
    RC_ASSERT(c.stable() <= entropy(c.mixed().data(), c.outcomes) + 1e-15);
    RC_ASSERT(binaryJensenShannon(c.pi.data(), c.rows.data(), c.n, c.outcomes) <= kLn2 + 1e-15);
  }));
}

TEST(Information, groupingOutcomesNeverAddsInformation) {
  EXPECT_TRUE(rc::check([] {
    const auto c = drawChildren();
    Children grouped{c.n, c.outcomes - 1, c.pi, {}};
    for (std::size_t i = 0; i < c.n; ++i) {
      const double* row = c.rows.data() + i * c.outcomes;
      grouped.rows.push_back(row[0] + row[1]);
      grouped.rows.insert(grouped.rows.end(), row + 2, row + c.outcomes);
    }
    RC_ASSERT(grouped.stable() <= c.stable() + 1e-15);
  }));
}

TEST(Information, splittingInTwoStepsAddsUp) {
  EXPECT_TRUE(rc::check([] {
    const auto c = drawChildren(3);
    // Merge the first two children first, then the merged one with the others.
    const double pair = c.pi[0] + c.pi[1];
    RC_PRE(pair > 0);
    const Children first{2,
                         c.outcomes,
                         {c.pi[0] / pair, c.pi[1] / pair},
                         {c.rows.begin(), c.rows.begin() + 2 * static_cast<long>(c.outcomes)}};
    Children rest{c.n - 1, c.outcomes, {pair}, first.mixed()};
    rest.pi.insert(rest.pi.end(), c.pi.begin() + 2, c.pi.end());
    rest.rows.insert(rest.rows.end(), c.rows.begin() + 2 * static_cast<long>(c.outcomes),
                     c.rows.end());
    RC_ASSERT(std::abs(c.stable() - (rest.stable() + pair * first.stable())) < 1e-14);
  }));
}

TEST(Information, childrenMayComeAsAnEigenMatrix) {
  const auto c = makeChildren(4, 3, 7);
  const Eigen::VectorXd pi = Eigen::Map<const Eigen::VectorXd>(c.pi.data(), 4);
  const ChildRows rows = Eigen::Map<const ChildRows>(c.rows.data(), 4, 3);
  EXPECT_EQ(jensenShannon(pi, rows), c.stable());
  EXPECT_THROW(jensenShannon(pi.head(3), rows), std::invalid_argument);
}
