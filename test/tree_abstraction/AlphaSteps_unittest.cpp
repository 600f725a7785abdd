#include <gtest/gtest.h>
#include <tree_abstraction/AlphaPath.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "FirstTrees.h"

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
