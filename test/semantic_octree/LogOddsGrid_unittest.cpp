// What it changes that a map keeps log-odds as multiples of 1/1024: the exact filter with and
// without rounding, side by side.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "FilterStreams.h"

using namespace semantic_octree;

namespace {

constexpr double kHalfUnit = 1 / 2048.;

/** The same observations for a filter that rounds and for one that does not. */
class TwoFilters {
 public:
  TwoFilters(int K, const FilterParameters& p)
      : m_rounded(K, p, ExactFilter::Grid::Stored), m_unrounded(K, p, ExactFilter::Grid::None) {}

  /** An observation of any kind, of three classes more often than of the others. */
  void observeAnything(std::mt19937& random) {
    const int kind = static_cast<int>(random() % 10);
    if (kind == 0) return both([](ExactFilter& f) { f.hit(); });
    if (kind <= 3) return both([](ExactFilter& f) { f.miss(); });
    if (kind == 4) return both([q = softLabel(random)](ExactFilter& f) { f.hit(q); });
    both([votes = someVotes(random)](ExactFilter& f) { f.hit(votes); });
  }

  double largestChange() const {
    double largest = 0;
    for (int k = 1; k <= m_rounded.K(); ++k)
      largest = std::max(largest, std::fabs(m_rounded.logOdds(k) - m_unrounded.logOdds(k)));
    return largest;
  }
  double changeOfDistribution() const {
    return totalVariation(m_rounded.distribution(), m_unrounded.distribution());
  }

 private:
  template <typename F>
  void both(const F& observe) {
    observe(m_rounded);
    observe(m_unrounded);
  }
  int someClass(std::mt19937& random) const {
    const unsigned among = random() % 5 ? std::min(3, m_rounded.K()) : m_rounded.K();
    return 1 + static_cast<int>(random() % among);
  }
  std::vector<float> softLabel(std::mt19937& random) const {
    std::vector<float> q(m_rounded.K());
    float sum = 0;
    for (float& x : q) sum += x = static_cast<float>(1 + random() % 1000);
    for (float& x : q) x /= sum;
    return q;
  }
  std::map<int, int> someVotes(std::mt19937& random) const {
    std::map<int, int> votes;
    for (int labels = 1 + static_cast<int>(random() % 10); labels > 0; --labels)
      ++votes[someClass(random)];
    return votes;
  }

  ExactFilter m_rounded, m_unrounded;
};

FilterParameters withoutLimits() {
  FilterParameters p;
  p.minOccupancy = 0;
  p.maxProbability = 1;
  return p;
}

}  // namespace

TEST(LogOddsGrid, changesLogOddsByNoMoreThanHalfAUnitPerObservationAndForThePrior) {
  EXPECT_TRUE(rc::check([](unsigned seed) {
    std::mt19937 random(seed);
    TwoFilters filters(std::array{1, 2, 3, 24, 254}[random() % 5], withoutLimits());
    double bound = kHalfUnit;
    RC_ASSERT(filters.largestChange() <= bound);
    for (int i = 0; i < 40; ++i) {
      filters.observeAnything(random);
      bound += kHalfUnit;
      RC_ASSERT(filters.largestChange() <= bound + 1e-12);
    }
  }));
}

TEST(LogOddsGrid, changesDistributionsByLessThanThreeThousandths) {
  std::mt19937 random(8);
  double sum = 0, worst = 0;
  int compared = 0;
  for (const int K : {2, 5, 24})
    for (int cell = 0; cell < 300; ++cell) {
      TwoFilters filters(K, {});
      for (int i = 0; i < 100; ++i) {
        filters.observeAnything(random);
        sum += filters.changeOfDistribution();
        worst = std::max(worst, filters.changeOfDistribution());
        ++compared;
      }
    }
  RecordProperty("mean total variation", std::to_string(sum / compared));
  RecordProperty("worst total variation", std::to_string(worst));
  EXPECT_LT(sum / compared, 2e-4);
  EXPECT_LT(worst, 3e-3);
}
