#include <gtest/gtest.h>

#include <algorithm>

#include "FilterStreams.h"

using namespace semantic_octree;

namespace {

/** Compares the filter with the exact one after each of some random soft labels of K <= 3 classes.
 */
template <typename Real>
void expectExactFilter(int K, ExactFilter::Grid grid, std::mt19937& random) {
  const ClassFilter<Real> filter(K, {});
  for (int stream = 0; stream < 100; ++stream) {
    ClassBelief<Real> belief = filter.uniform(0);
    ExactFilter exact(K, {}, grid);
    for (int i = 0; i < 10; ++i) {
      std::vector<float> q(K);
      float sum = 0;
      for (float& x : q) sum += x = static_cast<float>(random() % 1000);
      for (float& x : q) x /= std::max(1.f, sum);
      filter.hit(belief, q.data());
      exact.hit(q);
      ASSERT_LT(totalVariation(distributionOf(belief, K), exact.distribution()), 1e-9);
    }
  }
}

}  // namespace

TEST(SoftLabel, thatIsTheClassifiersRowEqualsTheHardLabel) {
  constexpr int K = 24;
  const FilterParameters p = wideLimits(0.8);
  const ClassFilter<double> filter(K, p);
  std::vector<float> row(K, static_cast<float>(0.2 / 23));
  row[6] = 0.8f;
  ClassBelief<double> soft = filter.uniform(0.3), hard = soft;
  filter.hit(soft, row.data());
  filter.hit(hard, 7);
  for (int k = 1; k <= K; ++k)
    EXPECT_NEAR(soft.logOddsOf(static_cast<ClassId>(k)), hard.logOddsOf(static_cast<ClassId>(k)),
                1e-6);
}

TEST(SoftLabel, thatIsTheFirstOfACellMeetsThePriorAndLaterOnesDoNot) {
  constexpr int K = 3;
  FilterParameters p = wideLimits();
  const ClassFilter<double> without(K, p);
  p.classPrior = {0.6f, 0.3f, 0.1f};
  const ClassFilter<double> with(K, p);
  const std::vector<std::vector<float>> rows = {{0.2f, 0.3f, 0.5f}, {0.4f, 0.2f, 0.4f}};
  ClassBelief<double> plain = without.uniform(0), informed = plain;
  for (const std::vector<float>& row : rows) {
    without.hit(plain, row.data());
    with.hit(informed, row.data());
    for (ClassId k = 2; k <= K; ++k)
      EXPECT_NEAR(
          informed.logOddsOf(k) - informed.logOddsOf(1),
          plain.logOddsOf(k) - plain.logOddsOf(1) + std::log(p.classPrior[k - 1] / p.classPrior[0]),
          1e-6);
  }
}

TEST(SoftLabel, oneHotApproachesTheHardLabelOfAPerfectClassifier) {
  constexpr int K = 5;
  for (const double floor : {0.01, 0.001, 0.0001}) {
    FilterParameters p = wideLimits(1 - (K - 1) * floor);
    p.softLabelFloor = floor;
    const ClassFilter<double> filter(K, p);
    const std::vector<float> oneHot{0, 0, 1, 0, 0};
    ClassBelief<double> soft = filter.uniform(0), hard = soft;
    filter.hit(soft, oneHot.data());
    filter.hit(hard, 3);
    EXPECT_LT(totalVariation(distributionOf(soft, K), distributionOf(hard, K)), K * floor);
    EXPECT_EQ(soft.ids[0], 3);
  }
}

TEST(SoftLabel, thatIsUniformEqualsAnUnlabeledHit) {
  constexpr int K = 4;
  const ClassFilter<double> filter(K, wideLimits());
  const std::vector<float> uniform(K, 0.25f);
  ClassBelief<double> soft = filter.uniform(-0.5);
  filter.hit(soft, 2);
  ClassBelief<double> unlabeled = soft;
  filter.hit(soft, uniform.data());
  filter.hit(unlabeled);
  for (int k = 1; k <= K; ++k)
    EXPECT_NEAR(soft.logOddsOf(static_cast<ClassId>(k)),
                unlabeled.logOddsOf(static_cast<ClassId>(k)), 1e-12);
}

TEST(SoftLabel, ofUpToThreeClassesEqualsTheExactFilter) {
  for (const int K : {1, 2, 3}) {
    std::mt19937 random(K);
    expectExactFilter<double>(K, ExactFilter::Grid::None, random);
    expectExactFilter<float>(K, ExactFilter::Grid::Stored, random);
  }
}

TEST(SoftLabel, ofManyClassesKeepsTheLikeliestAndTheOccupancy) {
  constexpr int K = 24;
  std::mt19937 random(2);
  const ClassFilter<double> filter(K, wideLimits());
  for (int round = 0; round < 100; ++round) {
    std::vector<float> q(K);
    float sum = 0;
    for (float& x : q) sum += x = static_cast<float>(1 + random() % 1000);
    for (float& x : q) x /= sum;
    ClassBelief<double> belief = filter.uniform(0);
    ExactFilter exact(K, wideLimits());
    filter.hit(belief, q.data());
    exact.hit(q);
    EXPECT_EQ(belief.ids[0], std::max_element(q.begin(), q.end()) - q.begin() + 1);
    EXPECT_NEAR(belief.occupancyLogOdds(K), exact.occupancyLogOdds(), 1e-9);
  }
}
