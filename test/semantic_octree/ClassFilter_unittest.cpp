#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <rapidcheck.h>

#include <type_traits>

#include "FilterStreams.h"

using namespace semantic_octree;

namespace {

double logit(double p) { return std::log(p / (1 - p)); }
double sigmoid(double h) { return 1 / (1 + std::exp(-h)); }

/** Largest difference of the truncated filter's and the exact filter's log-odds along random
 * streams. */
template <typename Real>
double largestDeviation(int K, int distinct, const FilterParameters& parameters, int length = 40) {
  std::mt19937 random(7 * K + distinct);
  const ClassFilter<Real> filter(K, parameters);
  double largest = 0;
  for (int stream = 0; stream < 100; ++stream) {
    ClassBelief<Real> belief = filter.uniform(0);
    ExactFilter exact(K, parameters);
    for (const Observation& z : randomStream(random, length, K, distinct)) {
      apply(filter, z, belief);
      apply(z, exact);
      for (int k = 1; k <= K; ++k)
        largest = std::max(largest,
                           std::fabs(belief.logOddsOf(static_cast<ClassId>(k)) - exact.logOdds(k)));
    }
  }
  return largest;
}

struct Deviation {
  double meanTotalVariation, rightShare, exactRightShare;
};

/** Mean distance to the exact filter after 20 labels of a classifier that errs evenly. */
Deviation deviationAfterTwentyLabels(double accuracy) {
  constexpr int K = 24, kCells = 4000;
  std::mt19937 random(1);
  FilterParameters parameters = wideLimits(accuracy);
  parameters.hitProbability = 0.7;
  parameters.falseAlarmProbability = 0.4;
  const ClassFilter<double> filter(K, parameters);
  Deviation d{};
  for (int cell = 0; cell < kCells; ++cell) {
    const auto truth = static_cast<ClassId>(1 + random() % K);
    ClassBelief<double> belief = filter.uniform(0);
    ExactFilter exact(K, parameters);
    for (int i = 0; i < 20; ++i) {
      const bool right = random() < accuracy * static_cast<double>(std::mt19937::max());
      const auto label = right ? truth : static_cast<ClassId>(1 + (truth + random() % (K - 1)) % K);
      filter.hit(belief, label);
      exact.hit(label);
    }
    const auto p = distributionOf(belief, K), q = exact.distribution();
    const auto best = [](const auto& v) {
      return std::max_element(v.begin() + 1, v.end()) - v.begin();
    };
    d.meanTotalVariation += totalVariation(p, q) / kCells;
    d.rightShare += (best(p) == truth) / static_cast<double>(kCells);
    d.exactRightShare += (best(q) == truth) / static_cast<double>(kCells);
  }
  return d;
}

}  // namespace

TEST(ClassFilter, equalsTheExactFilterUntilAFourthClassIsSeen) {
  for (const int K : {1, 2, 3, 4, 24, 254})
    for (int distinct = 1; distinct <= 3; ++distinct) {
      EXPECT_LT(largestDeviation<double>(K, distinct, {}), 1e-12) << "K = " << K;
      EXPECT_LT(largestDeviation<double>(K, distinct, wideLimits()), 1e-12) << "K = " << K;
    }
}

TEST(ClassFilter, inFloatEqualsTheExactFilterToFiveDigits) {
  for (const int K : {1, 2, 3, 4, 24, 254})
    EXPECT_LT(largestDeviation<float>(K, 3, {}, 10), 1e-5) << "K = " << K;
}

TEST(ClassFilter, withPublishedConstantsEqualsTheExactFilterToo) {
  FilterParameters ssmi;
  ssmi.increments = FilterParameters::Increments::Ssmi;
  EXPECT_LT(largestDeviation<double>(24, 3, ssmi), 1e-12);
}

TEST(ClassFilter, fourthClassLeavesTheOccupancyExact) {
  std::mt19937 random(3);
  const ClassFilter<double> filter(24, wideLimits());
  for (int stream = 0; stream < 200; ++stream) {
    ClassBelief<double> belief = filter.uniform(0);
    ExactFilter exact(24, wideLimits());
    for (const ClassId id : {3, 9, 4, 3, 9, 3}) filter.hit(belief, id), exact.hit(id);
    const auto fourth = static_cast<ClassId>(10 + random() % 15);
    filter.hit(belief, fourth), exact.hit(fourth);
    EXPECT_EQ(belief.count, 3);
    EXPECT_NEAR(belief.occupancyLogOdds(24), exact.occupancyLogOdds(), 1e-12);
  }
}

TEST(ClassFilter, evictsTheLeastLikelyClassAndOnATieTheLargestId) {
  const ClassFilter<double> filter(24, wideLimits());
  ClassBelief<double> belief = filter.uniform(0);
  for (const ClassId id : {5, 5, 2, 2, 8}) filter.hit(belief, id);
  filter.hit(belief, 7);  // later than 8, and so likelier than it
  EXPECT_EQ(belief.ids, (std::array<ClassId, 3>{2, 5, 7}));

  belief = filter.uniform(0);
  belief.count = 3;
  belief.ids = {1, 4, 9};
  belief.logOdds = {2, 1, belief.rest};
  ClassBelief<double> before = belief;
  filter.hit(belief, 6);
  EXPECT_EQ(belief.indexOf(9), -1) << "the newcomer is likelier than what it pushes out";
  EXPECT_GE(belief.indexOf(6), 0);
  EXPECT_EQ(before.unnamed(24), belief.unnamed(24));
}

TEST(ClassFilter, afterEvictionStaysNearTheExactFilter) {
  const Deviation at70 = deviationAfterTwentyLabels(0.7), at50 = deviationAfterTwentyLabels(0.5);
  EXPECT_LT(at70.meanTotalVariation, 1e-4);
  EXPECT_GT(at70.rightShare, 0.999);
  EXPECT_LT(at50.meanTotalVariation, 0.006);
  EXPECT_GT(at50.rightShare, at50.exactRightShare - 0.004);
}

TEST(ClassFilter, manyHitsOfAPoorClassifierKeepTheTrueClassApart) {
  // With these each hit raises all classes; clamped one by one they would end up equal.
  constexpr int K = 24;
  const ClassFilter<float> filter(K, wideLimits(0.6));
  ClassBelief<float> belief = filter.uniform(0);
  std::mt19937 random(4);
  for (int i = 0; i < 500; ++i)
    filter.hit(belief, static_cast<ClassId>(i % 10 < 6 ? 5 : 1 + random() % K));
  EXPECT_EQ(belief.ids[0], 5);
  EXPECT_GT(distributionOf(belief, K)[5], 0.9);
}

TEST(ClassFilter, withoutClampingTheOrderDoesNotMatterToTheLastBit) {
  FilterParameters gentle = wideLimits(0.5);
  gentle.hitProbability = 0.55;
  gentle.falseAlarmProbability = 0.45;
  const ClassFilter<float> filter(4, gentle);
  EXPECT_TRUE(rc::check([&](unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Observation> stream = randomStream(random, 8, 4, 3);
    ClassBelief<float> first = filter.uniform(0), second = first;
    for (const Observation& z : stream) apply(filter, z, first);
    std::shuffle(stream.begin(), stream.end(), random);
    for (const Observation& z : stream) apply(filter, z, second);
    RC_ASSERT(first == second);
  }));
}

TEST(ClassFilter, keepsNamedClassesSortedAndWithinTheirLimits) {
  const FilterParameters parameters;
  const ClassFilter<float> filter(24, parameters);
  const double lowest = logit(parameters.minOccupancy) - std::log(24.0);
  EXPECT_TRUE(rc::check([&](unsigned seed) {
    std::mt19937 random(seed);
    ClassBelief<float> belief = filter.uniform(0);
    for (const Observation& z : randomStream(random, 60, 24, 8)) {
      apply(filter, z, belief);
      for (int i = 0; i < belief.count; ++i) {
        RC_ASSERT(belief.logOdds[i] <= logit(parameters.maxProbability) + 1e-5);
        RC_ASSERT(belief.logOdds[i] >= lowest - 1e-5);
        if (i == 0) continue;
        RC_ASSERT(
            belief.logOdds[i - 1] > belief.logOdds[i] ||
            (belief.logOdds[i - 1] == belief.logOdds[i] && belief.ids[i - 1] < belief.ids[i]));
      }
      RC_ASSERT(belief.rest >= lowest - 1e-5);
    }
  }));
}

TEST(ClassFilter, ofACellWithoutClassesIsOctomapsOccupancyFilter) {
  const FilterParameters p;
  const ClassFilter<float> filter(24, p);
  octomap::OcTree octree(0.1);
  octree.setProbHit(sigmoid(std::log(p.hitProbability / p.falseAlarmProbability)));
  octree.setProbMiss(sigmoid(std::log((1 - p.hitProbability) / (1 - p.falseAlarmProbability))));
  octree.setClampingThresMin(p.minOccupancy);
  octree.setClampingThresMax(sigmoid(logit(p.maxProbability) + std::log(24.0)));
  std::mt19937 random(5);
  float value = 0;
  for (int i = 0; i < 2000; ++i) {
    const bool hit = random() % 3 == 0;
    value = hit ? filter.occupancyAfterUnlabeledHit(value) : filter.occupancyAfterMiss(value);
    EXPECT_NEAR(octree.updateNode(0.f, 0.f, 0.f, hit)->getLogOdds(), value, 2e-5 * (i + 1));
  }
}

TEST(ClassFilter, withoutRecordTakesTheSameValuesAsOnAUniformRecord) {
  const ClassFilter<float> filter(24, {});
  std::mt19937 random(6);
  float value = 0;
  ClassBelief<float> belief = filter.uniform(0);
  for (int i = 0; i < 1000; ++i) {
    const bool hit = random() % 3 == 0;
    value = hit ? filter.occupancyAfterUnlabeledHit(value) : filter.occupancyAfterMiss(value);
    hit ? filter.hit(belief) : filter.miss(belief);
    ASSERT_EQ(filter.uniform(value), belief);
    ASSERT_EQ(filter.occupancyOfUniform(belief.rest), value);
    ASSERT_NEAR(belief.occupancyLogOdds(24), value, 1e-5);
  }
}

TEST(ClassFilter, firstHitRaisesOccupancyByTheBinaryLikelihoodRatio) {
  for (const int K : {1, 2, 3, 24, 254})
    for (const double v : {-1.5, -0.3, 0.0, 2.0}) {
      const FilterParameters p = wideLimits();
      const ClassFilter<double> filter(K, p);
      ClassBelief<double> belief = filter.uniform(v);
      filter.hit(belief, 1);
      EXPECT_NEAR(belief.occupancyLogOdds(K),
                  v + std::log(p.hitProbability / p.falseAlarmProbability), 1e-12);
    }
}

TEST(ClassFilter, hitNeverLowersOccupancyWhereLabelsAgree) {
  const ClassFilter<float> filter(24, {});
  // The likeliest class at its limit: there the others' loss may take occupancy down to that limit.
  const float highest = static_cast<float>(logit(FilterParameters().maxProbability));
  EXPECT_TRUE(rc::check([&](unsigned seed) {
    std::mt19937 random(seed);
    ClassBelief<float> belief = filter.uniform(0);
    for (const Observation& z : randomStream(random, 30, 24, 1)) {
      const float before = belief.occupancyLogOdds(24);
      apply(filter, z, belief);
      const float after = belief.occupancyLogOdds(24);
      if (z.kind == Observation::Kind::Miss)
        RC_ASSERT(after <= before + 1e-6f);
      else
        RC_ASSERT(after >= std::min(before, highest) - 1e-6f);
    }
  }));
}

TEST(ClassFilter, withPublishedConstantsAFirstHitOf24ClassesLowersOccupancy) {
  FilterParameters ssmi;
  ssmi.increments = FilterParameters::Increments::Ssmi;
  const ClassFilter<double> filter(24, ssmi);
  ClassBelief<double> belief = filter.uniform(0);
  filter.hit(belief, 7);
  EXPECT_NEAR(distributionOf(belief, 24)[0], 24 / (24 + std::exp(1.0) + 23 * std::exp(-0.1)),
              1e-12);
  EXPECT_LT(belief.occupancyLogOdds(24), 0);
}

TEST(ClassFilter, pointsWithoutClassNeverChangeTheRatiosOfClasses) {
  const ClassFilter<float> filter(24, {});
  ClassBelief<float> belief = filter.uniform(0);
  for (const ClassId id : {4, 4, 9}) filter.hit(belief, id);
  const ClassBelief<float> before = belief;
  for (int i = 0; i < 100; ++i) filter.hit(belief);
  EXPECT_EQ(belief.ids, before.ids);
  EXPECT_EQ(belief.logOdds[0] - belief.logOdds[1], before.logOdds[0] - before.logOdds[1]);
  EXPECT_EQ(belief.logOdds[0] - belief.rest, before.logOdds[0] - before.rest);
}

TEST(ClassFilter, manyMissesMakeEveryClassEquallyUnlikely) {
  const ClassFilter<float> filter(24, {});
  ClassBelief<float> belief = filter.uniform(0);
  for (const ClassId id : {4, 4, 4, 9, 2}) filter.hit(belief, id);
  EXPECT_FALSE(belief.isUniform());
  for (int i = 0; i < 20; ++i) filter.miss(belief);
  EXPECT_TRUE(belief.isUniform());
  EXPECT_EQ(filter.occupancyOfUniform(belief.rest), filter.lowestOccupancy());
}

TEST(ClassFilter, distributionsAddUpToOne) {
  for (const int K : {1, 2, 3, 4, 254}) {
    const ClassFilter<float> filter(K, {});
    std::mt19937 random(K);
    ClassBelief<float> belief = filter.uniform(0);
    for (const Observation& z : randomStream(random, 100, K, 10)) {
      apply(filter, z, belief);
      const std::vector<double> p = distributionOf(belief, K);
      double sum = 0;
      for (const double x : p) sum += x;
      ASSERT_NEAR(sum, 1, 1e-12);
      ASSERT_NEAR(sigmoid(-belief.occupancyLogOdds(K)), p[0], 1e-6);
    }
  }
}

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
    const ClassFilter<double> filter(K, {});
    for (int stream = 0; stream < 100; ++stream) {
      ClassBelief<double> belief = filter.uniform(0);
      ExactFilter exact(K, {});
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

TEST(FilterParameters, thatMakeNoSenseAreRefusedByName) {
  const auto refusal = [](int K, void (*change)(FilterParameters&)) -> std::string {
    FilterParameters p;
    change(p);
    try {
      ClassFilter<float> filter(K, p);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "accepted";
  };
  const auto names = [](const std::string& what, const char* name) {
    return what.find(name) != std::string::npos;
  };
  const auto unchanged = [](FilterParameters&) {};
  EXPECT_PRED2(names, refusal(0, unchanged), "number of classes = 0");
  EXPECT_PRED2(names, refusal(255, unchanged), "number of classes = 255");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.accuracy = 0.2; }), "accuracy = 0.2");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.accuracy = 1; }), "accuracy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.accuracy = NAN; }), "accuracy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.hitProbability = 1; }),
               "hitProbability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.falseAlarmProbability = 0.6; }),
               "falseAlarmProbability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.falseAlarmProbability = 0; }),
               "falseAlarmProbability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.minOccupancy = 0.5; }),
               "minOccupancy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.minOccupancy = 0; }), "minOccupancy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.maxProbability = 0.5; }),
               "maxProbability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.softLabelFloor = 0; }),
               "softLabelFloor");
  EXPECT_EQ(refusal(1, [](FilterParameters& p) { p.accuracy = 0.5; }), "accepted");
  EXPECT_EQ(refusal(254, unchanged), "accepted");
}
