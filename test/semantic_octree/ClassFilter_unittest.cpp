#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <semantic_octree/ClassFilter.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "FilterStreams.h"
#include "TemporaryFolder.h"

using namespace semantic_octree;

namespace {

/** Largest difference of the truncated filter's and the exact filter's log-odds along random
 * streams. */
double largestDeviation(int K, int distinct, const FilterParameters& parameters, int length = 40) {
  std::mt19937 random(7 * K + distinct);
  const ClassFilter filter(K, parameters);
  double largest = 0;
  for (int stream = 0; stream < 100; ++stream) {
    ClassBelief belief = filter.uniform(0);
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

TEST(ClassFilter, equalsTheExactFilterToTheLastBitUntilAFourthClassIsSeen) {
  for (const int K : {1, 2, 3, 4, 24, 254})
    for (int distinct = 1; distinct <= 3; ++distinct)
      for (const FilterParameters& parameters : {FilterParameters(), wideLimits()})
        EXPECT_EQ(largestDeviation(K, distinct, parameters), 0) << "K = " << K;
}

TEST(ClassFilter, fourthClassLeavesTheOccupancy) {
  std::mt19937 random(3);
  const ClassFilter filter(24, wideLimits());
  for (int stream = 0; stream < 200; ++stream) {
    ClassBelief belief = filter.uniform(0);
    ExactFilter exact(24, wideLimits());
    std::vector<ClassId> ids = {3, 9, 4, 3, 9, 3};
    if (stream % 2) ids.push_back(4);
    ids.push_back(static_cast<ClassId>(10 + random() % 15));
    for (const ClassId id : ids) filter.hit(belief, id), exact.hit(id);
    EXPECT_EQ(belief.count, 3);
    EXPECT_NEAR(belief.occupancyLogOdds(24), exact.occupancyLogOdds(), kTick);
  }
}

TEST(ClassFilter, evictsTheLeastLikelyClassAndOnATieTheLargestId) {
  const ClassFilter filter(24, wideLimits());
  ClassBelief belief = filter.uniform(0);
  for (const ClassId id : {5, 5, 2, 2, 8}) filter.hit(belief, id);
  filter.hit(belief, 7);  // later than 8, and so likelier than it
  EXPECT_EQ(belief.ids, (std::array<ClassId, 3>{2, 5, 7}));

  belief = filter.uniform(0);
  belief.count = 3;
  belief.ids = {1, 4, 9};
  belief.logOdds = {2, 1, belief.rest};
  ClassBelief before = belief;
  filter.hit(belief, 6);
  EXPECT_EQ(belief.indexOf(9), -1) << "the newcomer is likelier than what it pushes out";
  EXPECT_GE(belief.indexOf(6), 0);
  EXPECT_EQ(before.unnamed(24), belief.unnamed(24));
}

TEST(ClassFilter, keepsNamedClassesSortedAndWithinTheirLimits) {
  const FilterParameters parameters;
  const ClassFilter filter(24, parameters);
  const double highest = stored(logit(parameters.maxProbability)),
               lowest = stored(logit(parameters.minOccupancy)) - stored(std::log(24.0));
  EXPECT_TRUE(rc::check([&](unsigned seed) {
    std::mt19937 random(seed);
    ClassBelief belief = filter.uniform(0);
    for (const Observation& z : randomStream(random, 60, 24, 8)) {
      apply(filter, z, belief);
      for (int i = 0; i < belief.count; ++i) {
        RC_ASSERT(belief.logOdds[i] <= highest);
        RC_ASSERT(belief.logOdds[i] >= lowest);
        if (i == 0) continue;
        RC_ASSERT(
            belief.logOdds[i - 1] > belief.logOdds[i] ||
            (belief.logOdds[i - 1] == belief.logOdds[i] && belief.ids[i - 1] < belief.ids[i]));
      }
      RC_ASSERT(belief.rest >= lowest);
    }
  }));
}

TEST(ClassFilter, withoutRecordTakesTheSameValuesAsOnAUniformRecord) {
  const ClassFilter filter(24, {});
  std::mt19937 random(6);
  float value = 0;
  ClassBelief belief = filter.uniform(0);
  for (int i = 0; i < 1000; ++i) {
    const bool hit = random() % 3 == 0;
    value = hit ? filter.occupancyAfterUnlabeledHit(value) : filter.occupancyAfterMiss(value);
    hit ? filter.hit(belief) : filter.miss(belief);
    ASSERT_EQ(filter.uniform(value), belief);
    ASSERT_EQ(filter.occupancyOfUniform(belief.rest), value);
    ASSERT_EQ(filter.occupancyOf(belief), value);
    ASSERT_NEAR(belief.occupancyLogOdds(24), value, 1 / 2048.) << "for ln 24 is rounded";
  }
}

// The numbers of vectors.json were computed by an independent script from the filter's formulas.

nlohmann::json vectors() {
  std::ifstream in(MSO_SOURCE_DIR "/test/semantic_octree/vectors.json");
  return nlohmann::json::parse(in);
}

}  // namespace

TEST(Vectors, likelihoodConsistentIncrementsAreTheTabulatedOnes) {
  const auto v = vectors()["likelihood_increments"];
  const int K = v["K"];
  FilterParameters parameters = wideLimits(v["accuracy"]);
  parameters.hitProbability = v["p_hit"];
  parameters.falseAlarmProbability = v["p_fa"];
  const ClassFilter filter(K, parameters);
  const ClassBelief prior = filter.uniform(0);
  ClassBelief seen = prior, missed = prior, unlabeled = prior;
  filter.hit(seen, 7);
  filter.miss(missed);
  filter.hit(unlabeled);
  EXPECT_EQ(seen.logOddsOf(7) - prior.rest, stored(v["psi"]));
  EXPECT_EQ(seen.rest - prior.rest, stored(v["phi_hit_other"]));
  EXPECT_EQ(missed.rest - prior.rest, stored(v["phi_miss"]));
  EXPECT_EQ(unlabeled.rest - prior.rest,
            stored(std::log(v["mean_uniform_exp_increment_equals_phit_over_pfa"].get<double>())));
  const auto& expected = v["one_hit_from_occ_prior_0.5"];
  const std::vector<double> p = distributionOf(seen, K);
  EXPECT_NEAR(p[0], expected["p_free"].get<double>(), kTick);
  EXPECT_NEAR(p[7], expected["p_hit_class"].get<double>(), kTick);
  EXPECT_NEAR(p[1], expected["p_each_other"].get<double>(), kTick);
}

TEST(FilterParameters, thatMakeNoSenseAreRefusedByName) {
  using P = FilterParameters;
  const auto refusal = [](int K, void (*change)(P&)) {
    P p;
    change(p);
    return errorOf([&] { ClassFilter(K, p); });
  };
  const auto unchanged = [](P&) {};
  EXPECT_TRUE(contains(refusal(0, unchanged), "number of classes is 0"));
  EXPECT_TRUE(contains(refusal(255, unchanged), "number of classes is 255"));
  const std::pair<void (*)(P&), const char*> faults[] = {
      {[](P& p) { p.accuracy = 0.2; }, "accuracy is 0.2"},
      {[](P& p) { p.falseAlarmProbability = 0.6; }, "false_alarm_probability"},
      {[](P& p) { p.minOccupancy = 0.5; }, "min_occupancy"},
      {[](P& p) { p.maxProbability = 0.5; }, "max_probability"},
      {[](P& p) { p.softLabelFloor = 0; }, "soft_label_floor"},
      {[](P& p) { p.hitProbability = 1 - 0.99e-9; }, "hit_probability"},
      {[](P& p) { p.minOccupancy = 0.99e-9; }, "min_occupancy"},
      {[](P& p) { p.maxProbability = 1 - 0.99e-9; }, "max_probability"}};
  for (const auto& [change, words] : faults)
    EXPECT_TRUE(contains(refusal(5, change), words)) << words << ": " << refusal(5, change);
  EXPECT_EQ(refusal(1, [](P& p) { p.accuracy = 0.5; }), "");
  void (*const fine[])(P&) = {unchanged, [](P& p) { p.minOccupancy = 1e-9; },
                              [](P& p) { p.hitProbability = 1 - 1e-9; },
                              [](P& p) { p.maxProbability = 1 - 1e-9; }};
  for (const auto& change : fine) EXPECT_EQ(refusal(254, change), "");
}
