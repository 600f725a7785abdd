// What several labels of one scan in one cell say.
#include <gtest/gtest.h>
#include <semantic_octree/ClassFilter.h>

#include <algorithm>
#include <random>

#include "ExactFilter.h"
#include "FilterStreams.h"
#include "RandomScans.h"

using namespace semantic_octree;

namespace {

using Votes = std::map<int, int>;

void hit(const ClassFilter& filter, ClassBelief& belief, const Votes& votes) {
  std::vector<ClassVotes> ascending;
  for (const auto& [id, count] : votes)
    ascending.push_back({static_cast<ClassId>(id), static_cast<std::uint32_t>(count)});
  filter.hit(belief, ascending.data(), ascending.size());
}

ClassBelief after(const ClassFilter& filter, const Votes& votes) {
  ClassBelief belief = filter.uniform(0);
  hit(filter, belief, votes);
  return belief;
}

/** Up to `most` labels, of classes up to K. */
Votes randomVotes(std::mt19937& random, int K, int most) {
  Votes votes;
  const int labels = 1 + static_cast<int>(random() % most);
  for (int i = 0; i < labels; ++i) ++votes[1 + static_cast<int>(random() % K)];
  return votes;
}

/** Compares the filter with the exact one along streams of votes for up to three classes. */
void expectExactVotes(int K, std::mt19937& random) {
  FilterParameters p;
  p.labelCorrelation = between(random, 0.001, 1);
  const ClassFilter filter(K, p);
  for (int stream = 0; stream < 100; ++stream) {
    ClassBelief belief = filter.uniform(0);
    ExactFilter exact(K, p);
    for (int i = 0; i < 10; ++i) {
      const Votes votes = randomVotes(random, std::min(K, 3), 200);
      hit(filter, belief, votes);
      exact.hit(votes);
      if (random() % 3 == 0) filter.miss(belief), exact.miss();
      ASSERT_LT(totalVariation(distributionOf(belief, K), exact.distribution()), 1e-9);
    }
  }
}

TEST(Votes, ofUpToThreeClassesEqualTheExactFilter) {
  std::mt19937 random(5);
  for (const int K : {2, 3, 4, 24}) expectExactVotes(K, random);
}

TEST(Votes, ofManyClassesKeepTheLikeliestAndTheOccupancy) {
  constexpr int K = 24;
  std::mt19937 random(2);
  const ClassFilter filter(K, wideLimits());
  for (int round = 0; round < 100; ++round) {
    const Votes votes = randomVotes(random, K, 100);
    const ClassBelief belief = after(filter, votes);
    ExactFilter exact(K, wideLimits());
    exact.hit(votes);
    EXPECT_NEAR(belief.occupancyLogOdds(K), exact.occupancyLogOdds(), kTick);
    for (int i = 0; i < belief.count; ++i)
      EXPECT_NEAR(belief.logOdds[i], exact.logOdds(belief.ids[i]), 1e-9);
    std::vector<double> odds;
    for (int k = 1; k <= K; ++k) odds.push_back(exact.logOdds(k));
    std::sort(odds.rbegin(), odds.rend());
    for (int i = 0; i < std::min<int>(3, static_cast<int>(votes.size())); ++i)
      EXPECT_NEAR(belief.logOdds[i], odds[i], 1e-9);
  }
}

TEST(Votes, ofTheOnlyClassAreItsHit) {
  const ClassFilter filter(1, {});
  ClassBelief labeled = filter.uniform(0);
  filter.hit(labeled, 1);
  EXPECT_TRUE(after(filter, {{1, 5}}) == labeled);
}

/** Compares the filter with the exact one after each of some random soft labels of K <= 3 classes.
 */
void expectExactFilter(int K, std::mt19937& random) {
  const ClassFilter filter(K, {});
  for (int stream = 0; stream < 100; ++stream) {
    ClassBelief belief = filter.uniform(0);
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

}  // namespace

TEST(SoftLabel, thatIsTheFirstOfACellMeetsThePriorAndLaterOnesDoNot) {
  constexpr int K = 3;
  FilterParameters p = wideLimits();
  const ClassFilter without(K, p);
  p.classPrior = {0.6f, 0.3f, 0.1f};
  const ClassFilter with(K, p);
  const std::vector<std::vector<float>> rows = {{0.2f, 0.3f, 0.5f}, {0.4f, 0.2f, 0.4f}};
  ClassBelief plain = without.uniform(0), informed = plain;
  for (const std::vector<float>& row : rows) {
    without.hit(plain, row.data());
    with.hit(informed, row.data());
    for (ClassId k = 2; k <= K; ++k)
      EXPECT_NEAR(
          informed.logOddsOf(k) - informed.logOddsOf(1),
          plain.logOddsOf(k) - plain.logOddsOf(1) + std::log(p.classPrior[k - 1] / p.classPrior[0]),
          2 * kTick);
  }
}

TEST(SoftLabel, ofUpToThreeClassesEqualsTheExactFilter) {
  for (const int K : {1, 2, 3}) {
    std::mt19937 random(K);
    expectExactFilter(K, random);
  }
}

TEST(SoftLabel, ofManyClassesKeepsTheLikeliestAndTheOccupancy) {
  constexpr int K = 24;
  std::mt19937 random(2);
  const ClassFilter filter(K, wideLimits());
  for (int round = 0; round < 100; ++round) {
    std::vector<float> q(K);
    float sum = 0;
    for (float& x : q) sum += x = static_cast<float>(1 + random() % 1000);
    for (float& x : q) x /= sum;
    ClassBelief belief = filter.uniform(0);
    ExactFilter exact(K, wideLimits());
    filter.hit(belief, q.data());
    exact.hit(q);
    EXPECT_EQ(belief.ids[0], std::max_element(q.begin(), q.end()) - q.begin() + 1);
    EXPECT_NEAR(belief.occupancyLogOdds(K), exact.occupancyLogOdds(), kTick);
  }
}
