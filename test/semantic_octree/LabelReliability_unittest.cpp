// What a scan's labels say of their own reliability, next to urns whose reliability is known.
#include <gtest/gtest.h>
#include <semantic_octree/ClassFilter.h>
#include <semantic_octree/LabelReliability.h>

#include <algorithm>
#include <random>

using namespace semantic_octree;

namespace {

FilterParameters trusting(double accuracy, double correlation) {
  FilterParameters p;
  p.accuracy = accuracy, p.labelCorrelation = correlation;
  return p;
}

/** Labels of cells of random classes: each repeats the one before with probability `correlation`,
 * else it is drawn anew. */
LabelAgreement agreementOfPairs(double accuracy, double correlation, int K, int cells,
                                std::mt19937& random) {
  std::uniform_real_distribution<double> chance;
  LabelAgreement agreement;
  for (int i = 0; i < cells; ++i) {
    const int truth = 1 + static_cast<int>(random() % static_cast<unsigned>(K));
    const auto draw = [&] {
      if (chance(random) < accuracy) return static_cast<ClassId>(truth);
      const int other = 1 + static_cast<int>(random() % static_cast<unsigned>(K - 1));
      return static_cast<ClassId>(other + (other >= truth));
    };
    ClassId labels[2] = {draw(), draw()};
    if (chance(random) < correlation) labels[1] = labels[0];
    std::sort(labels, labels + 2);
    agreement.add(labels, labels + 2);
  }
  return agreement;
}

}  // namespace

TEST(LabelReliability, isThatOfUrnsWithinWhatTheParametersAllow) {
  std::mt19937 random(1);
  const FilterParameters most = trusting(0.9, 1);
  for (const int K : {3, 10, 24}) {
    for (const double r : {0.0, 0.3, 0.6}) {
      const auto labels = agreementOfPairs(0.9, r, K, 60000, random).explain(most, K);
      EXPECT_NEAR(labels.accuracy, 0.9, 0.01);
      EXPECT_NEAR(labels.correlation, r, 0.07) << K;
    }
    for (const double accuracy : {0.5, 0.7, 0.8}) {
      const auto labels = agreementOfPairs(accuracy, 0, K, 60000, random).explain(most, K);
      EXPECT_NEAR(labels.accuracy, accuracy, 0.03) << K;
      EXPECT_LE(labels.correlation, 0.02);
    }
  }
}

TEST(LabelReliability, isNeverMoreThanTheParametersSay) {
  std::mt19937 random(2);
  const FilterParameters most = trusting(0.8, 0.4);
  for (const double accuracy : {0.6, 0.8, 0.99})
    for (const double r : {0.0, 0.4, 0.9}) {
      const auto labels = agreementOfPairs(accuracy, r, 10, 20000, random).explain(most, 10);
      EXPECT_LE(labels.accuracy, 0.8);
      EXPECT_LE(labels.correlation, 0.4);
      EXPECT_EQ(labels == (LabelReliability{0.8, 0.4}),
                accuracy == 0.99 || r > 0.5 || (accuracy > 0.7 && r > 0.3));
    }
}

TEST(LabelReliability, ofAFilterThatExpectsLittleIsThatOfUrnsToo) {
  std::mt19937 random(3);
  const auto labels = agreementOfPairs(0.5, 0.3, 3, 60000, random).explain(trusting(0.5, 1), 3);
  EXPECT_NEAR(labels.correlation, 0.3, 0.03);
  const auto guesses = agreementOfPairs(0.35, 0, 3, 60000, random).explain(trusting(0.34, 1), 3);
  EXPECT_LE(guesses.accuracy, 0.34);
}

TEST(LabelReliability, takesManyLabelsToDiffer) {
  const FilterParameters p = trusting(0.9, 0.5);
  const LabelReliability most{0.9, 0.5};
  LabelAgreement agreement;
  EXPECT_TRUE(agreement.explain(p, 24) == most);
  const ClassId alone[] = {4}, different[] = {3, 8};
  for (int i = 0; i < 100000; ++i) agreement.add(alone, alone + 1);
  for (int i = 0; i < 4; ++i) agreement.add(different, different + 2);
  EXPECT_TRUE(agreement.explain(p, 24) == most);
  for (int i = 0; i < 50; ++i) agreement.add(different, different + 2);
  EXPECT_LT(agreement.explain(p, 24).correlation, 0.5);
}

TEST(LabelReliability, ofLabelsByChanceIsStillThatOfAFilter) {
  const ClassId labels[] = {1, 2};
  LabelAgreement never;
  for (int i = 0; i < 1000000; ++i) never.add(labels, labels + 2);
  EXPECT_TRUE(never.explain(trusting(0.9, 0.5), 1) == (LabelReliability{0.9, 0.5})) << "one class";
  for (const int K : {2, 3, 24, 254}) {
    const LabelReliability reliability = never.explain(trusting(0.999, 0.5), K);
    EXPECT_GT(reliability.accuracy * K, 1);
    EXPECT_LT(reliability.accuracy, 1.0 / K + 0.13);
    EXPECT_NO_THROW((ClassFilter(K, {}).trusting(reliability)));
  }
}
