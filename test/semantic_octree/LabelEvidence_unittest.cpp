// What n labels of a scan say of a class, next to urns, counting and the definition of correlation.
#include <gtest/gtest.h>
#include <semantic_octree/LabelEvidence.h>

#include <algorithm>
#include <random>

#include "ExactFilter.h"

using namespace semantic_octree;

namespace {

/** ln p(n labels of class 1 | class 1) - ln p(the same | class 2), label by label from the urn. */
double evidenceOfTheUrn(double accuracy, int K, double correlation, int n) {
  FilterParameters p;
  p.accuracy = accuracy;
  p.labelCorrelation = correlation;
  const ExactFilter urn(K, p);
  const std::vector<int> labels(static_cast<std::size_t>(n), 1);
  return urn.logLikelihoodOf(labels, 1) - urn.logLikelihoodOf(labels, 2);
}

}  // namespace

TEST(LabelEvidence, ofRandomLabelsIsThatOfPolyasUrnInAnyOrder) {
  std::mt19937 random(1);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  for (int round = 0; round < 300; ++round) {
    const int K = 2 + static_cast<int>(random() % 30);
    FilterParameters p;
    p.accuracy = between(1.01 / K, 0.999), p.labelCorrelation = between(1e-4, 1);
    const LabelEvidence evidence(p.accuracy, K, p.labelCorrelation);
    const ExactFilter urn(K, p);
    std::map<int, int> votes;
    for (int i = 1 + static_cast<int>(random() % 150); i > 0; --i)
      ++votes[1 + static_cast<int>(random() % static_cast<unsigned>(std::min(K, 4)))];
    std::vector<int> labels = ExactFilter::labelsOf(votes);
    const double first = urn.logLikelihoodOf(labels, 1);
    std::shuffle(labels.begin(), labels.end(), random);
    EXPECT_NEAR(urn.logLikelihoodOf(labels, 1), first, 1e-9);
    for (int k = 2; k <= K; ++k)
      ASSERT_NEAR(evidence(votes[1]) - evidence(votes[k]), first - urn.logLikelihoodOf(labels, k),
                  1e-6);
  }
}

TEST(LabelEvidence, ofTwoLabelsFollowsFromTheDefinitionOfCorrelation) {
  // Two indicators of mean p, correlated by r, are both 1 with p^2 + r p (1 - p).
  for (const double r : {0.0, 0.1, 0.2, 0.7, 1.0}) {
    const double right = 0.8, wrong = 0.05;
    const auto both = [r](double p) { return p * p + r * p * (1 - p); };
    EXPECT_NEAR(LabelEvidence(right, 5, r)(2), std::log(both(right) / both(wrong)), 1e-6) << r;
  }
}

TEST(LabelEvidence, isCountingWithoutCorrelationAndOneLabelWithAllOfIt) {
  const LabelEvidence counting(0.9, 24, 0), one(0.9, 24, 1);
  for (const std::uint32_t n : {1u, 2u, 7u, 64u, 65u, 300u}) {
    EXPECT_NEAR(counting(n) / counting(1), n, 0.003) << n;
    EXPECT_NEAR(one(n), one(1), 1e-9) << n;
  }
}

TEST(LabelEvidence, ofManyLabelsGoesOnWhereTheSumOfFewEnds) {
  for (const double r : {1e-8, 1e-6, 1e-3, 0.2, 0.5, 1.0})
    for (const int n : {63, 64, 65, 66, 100, 1000, 30000})
      EXPECT_NEAR(LabelEvidence(0.9, 24, r)(static_cast<std::uint32_t>(n)),
                  evidenceOfTheUrn(0.9, 24, r, n), 1e-4)
          << n << " labels, correlation " << r;
}
