#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "Groups.h"

using namespace planning_study;

namespace {

Trial solved(std::size_t instance, std::vector<Length> way, double searchTime = 0) {
  Trial trial;
  trial.instance = instance;
  trial.found = true;
  trial.way = std::move(way);
  trial.searchTime = searchTime;
  return trial;
}

std::vector<double> normalSample(std::size_t count, double center, double spread) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(center, spread);
  std::vector<double> sample(count);
  for (double& x : sample) x = normal(random);
  return sample;
}

Interval intervalOfMean(const std::vector<double>& sample) {
  return bootstrap(sample.size(), [&](const auto& which) { return mean(pick(sample, which)); });
}

}  // namespace

TEST(StudyStatistics, fiveNumbersAreDescribedAsByHand) {
  const Distribution d = describe({10, 1, 3, 4, 2});
  EXPECT_EQ(d.count, 5u);
  EXPECT_DOUBLE_EQ(d.mean, 4);
  EXPECT_DOUBLE_EQ(d.deviation, std::sqrt((9 + 4 + 1 + 0 + 36) / 4.0));
  EXPECT_DOUBLE_EQ(d.quartile1, 2);
  EXPECT_DOUBLE_EQ(d.median, 3);
  EXPECT_DOUBLE_EQ(d.quartile3, 4);
  EXPECT_DOUBLE_EQ(d.percentile5, 1.2);
  EXPECT_DOUBLE_EQ(d.percentile95, 8.8);  // 0.8 of the way from the fourth to the fifth
}

TEST(StudyStatistics, theMedianOfAnEvenCountLiesBetween) {
  EXPECT_DOUBLE_EQ(describe({4, 1, 2, 8}).median, 3);
}

TEST(StudyStatistics, oneNumberHasNoDeviationAndNoneHasNothing) {
  EXPECT_DOUBLE_EQ(describe({3}).deviation, 0);
  EXPECT_DOUBLE_EQ(describe({3}).percentile95, 3);
  EXPECT_EQ(describe({}).count, 0u);
  const Interval nothing = intervalOfMean({});
  EXPECT_EQ(nothing.low, 0);
  EXPECT_EQ(nothing.high, 0);
}

TEST(StudyStatistics, theBootstrapOfAMeanAgreesWithTheNormalInterval) {
  const auto sample = normalSample(400, 10, 2);
  const Interval interval = intervalOfMean(sample);
  const double half = 1.96 * deviation(sample) / std::sqrt(400.0);
  EXPECT_NEAR(interval.low, mean(sample) - half, 0.1 * half);
  EXPECT_NEAR(interval.high, mean(sample) + half, 0.1 * half);
}

TEST(StudyStatistics, theBootstrapKeepsPairsTogether) {
  const auto a = normalSample(50, 10, 5);
  const Interval difference = bootstrap(a.size(), [&](const auto& which) {
    auto b = a;  // each 3 more
    for (double& x : b) x += 3;
    return mean(pick(a, which)) - mean(pick(b, which));
  });
  EXPECT_NEAR(difference.low, -3, 1e-9);
  EXPECT_NEAR(difference.high, -3, 1e-9);
}

TEST(StudyStatistics, pathsAreComparedWorstRankFirstAndNoPathIsWorst) {
  const Trial grass = solved(0, {0, 50, 100}), mud = solved(0, {1, 0, 10}), none;
  EXPECT_LT(compareTrials(grass, mud, &Trial::way), 0);
  EXPECT_GT(compareTrials(mud, grass, &Trial::way), 0);
  EXPECT_EQ(compareTrials(mud, mud, &Trial::way), 0);
  EXPECT_LT(compareTrials(mud, none, &Trial::way), 0);
  EXPECT_EQ(compareTrials(none, none, &Trial::way), 0);
}

TEST(StudyStatistics, aWayHasTheWorseRanksAndTheTotal) {
  const colored_graph::ClassOrder order(5, {{1, 4}, {2}, {0}});  // 3 is forbidden
  EXPECT_EQ(wayOf({7, 100, 20, 0, 5}, order), (std::vector<Length>{7, 20, 132}));
}

TEST(StudyStatistics, metersOutsideTheBestRankLeaveTheTotalOut) {
  const Trial trial = solved(0, {10000, 25000, 90000});
  EXPECT_DOUBLE_EQ(metersOutsideBest(trial), 3.5);
  EXPECT_DOUBLE_EQ(meters(trial), 9);
}

TEST(StudyStatistics, aMeterOfAWorseRankWeighsTenTimesAsMuch) {
  EXPECT_DOUBLE_EQ(weightedMeters(solved(0, {10000, 25000, 90000})), 100 * 1 + 10 * 2.5 + 5.5);
}

TEST(StudyStatistics, waysToPlanThatRememberAreWaysOfTheirOwn) {
  std::vector<Trial> trials(2, solved(0, {1}));
  trials[1].kept = true;
  EXPECT_EQ(groupsOf(trials).size(), 2u);
}

TEST(StudyStatistics, pairsAreOfTheSameInstance) {
  const std::vector<Trial> a = {solved(0, {1}, 5), solved(2, {1}, 6), solved(3, {1}, 7)};
  std::vector<Trial> b = {solved(3, {1}, 70), solved(1, {1}, 60), solved(2, {1}, 50)};
  b[2].found = false;
  const Pairs pairs = pairsOf(groupsOf(a).begin()->second, groupsOf(b).begin()->second);
  ASSERT_EQ(pairs.all.size(), 2u);
  ASSERT_EQ(pairs.solved.size(), 1u);
  EXPECT_EQ(pairs.solved[0].first->searchTime, 7);
  EXPECT_EQ(pairs.solved[0].second->searchTime, 70);
}
