#include <gtest/gtest.h>
#include <tree_abstraction/AbstractionWeights.h>

#include <cmath>
#include <limits>

#include "TemporaryFolder.h"

using namespace tree_abstraction;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/** Message of the exception that validation for 4 classes throws; empty if it throws none. */
std::string rejection(const AbstractionWeights& weights) {
  return errorOf([&] { weights.validate(4); });
}

void expectRejected(const AbstractionWeights& weights, const std::vector<std::string>& words) {
  const std::string message = rejection(weights);
  EXPECT_NE(message, "");
  for (const auto& word : words) EXPECT_TRUE(contains(message, word));
}

/** The row of a node of this class distribution. */
std::vector<double> project(const std::vector<InformationTerm>& weighed,
                            const std::vector<double>& p) {
  const TermSet terms({weighed, 0.0}, static_cast<int>(p.size()) - 1);
  std::vector<double> row(terms.width());
  for (const auto& [classId, entry] : terms.contributions()) row[entry] += p[classId];
  return row;
}

const std::vector<double> kDistribution = {0.5, 0.25, 0.125, 0.0625, 0.0625};

}  // namespace

TEST(AbstractionWeights, acceptsOverlapThatContradictsNothing) {
  EXPECT_EQ(rejection({{relevant("road", 1, {1}), relevant("drivable", 2, {1, 2}),
                        irrelevant("tree", 0.3, {3}), wholeClassVariable("all", -0.1, 4)},
                       0.5}),
            "");
  EXPECT_EQ(rejection({}), "");
  EXPECT_EQ(rejection({{{"measured", 0, {{1}}}, irrelevant("one", 1, {1})}, 0}), "");
}

TEST(AbstractionWeights, rejectsNumbersThatAreNotFiniteAndNamesThem) {
  expectRejected({{}, kNan}, {"alpha", "nan"});
  expectRejected({{}, kInfinity}, {"alpha", "inf"});
  expectRejected({{}, -0.1}, {"alpha", "-0.1"});
  expectRejected({{{"road", kNan, {{1}}}}, 1}, {"'road'", "weight", "nan"});
  expectRejected({{{"road", -kInfinity, {{1}}}}, 1}, {"'road'", "weight", "inf"});
}

TEST(AbstractionWeights, relevantAndIrrelevantTakeWeightsThatAreNotNegative) {
  EXPECT_EQ(relevant("a", 2, {1}).weight, 2);
  EXPECT_EQ(irrelevant("a", 2, {1}).weight, -2);
  EXPECT_FALSE(std::signbit(irrelevant("a", 0, {1}).weight));
  for (const double bad : {-1.0, kNan, kInfinity}) {
    EXPECT_THROW(relevant("a", bad, {1}), std::invalid_argument);
    EXPECT_THROW(irrelevant("a", bad, {1}), std::invalid_argument);
  }
}

TEST(AbstractionWeights, rejectsGroupsThatMakeNoVariable) {
  expectRejected({{{"road", 1, {}}}, 0}, {"'road'", "no group"});
  expectRejected({{{"road", 1, {{1}, {}}}}, 0}, {"'road'", "without a class"});
  expectRejected({{{"road", 1, {{5}}}}, 0}, {"'road'", "class 5", "0..4"});
  expectRejected({{{"road", 1, {{-1}}}}, 0}, {"'road'", "class -1", "0..4"});
  expectRejected({{{"road", 1, {{1, 2}, {2}}}}, 0}, {"'road'", "class 2", "more than one group"});
  expectRejected({{{"road", 1, {{1, 1}}}}, 0}, {"'road'", "class 1", "more than one group"});
  expectRejected({{relevant("road", 1, {1}), relevant("road", 1, {2})}, 0},
                 {"'road'", "two terms"});
}

TEST(TermSet, otherTermsKeepEveryOutcomeTheRestLast) {
  EXPECT_EQ(project({{"a", 1, {{2}, {4, 1}}}}, kDistribution),
            (std::vector<double>{0.125, 0.3125, 0.5625}));
  EXPECT_EQ(project({wholeClassVariable("all", 1, 4)}, kDistribution), kDistribution);
}

TEST(TermSet, rowsHoldTheTermsOneAfterTheOther) {
  const std::vector<InformationTerm> weighed = {
      relevant("a", 1, {1}), {"b", 1, {{2}, {3}}}, irrelevant("c", 1, {4})};
  const TermSet terms({weighed, 0}, 4);
  ASSERT_EQ(terms.size(), 3u);
  EXPECT_EQ(terms.width(), 5u);
  EXPECT_TRUE(terms.slot(0).isBinary());
  EXPECT_EQ(terms.slot(1).offset, 1u);
  EXPECT_EQ(terms.slot(1).width, 3u);
  EXPECT_EQ(terms.slot(2).offset, 4u);
  EXPECT_EQ(project(weighed, kDistribution),
            (std::vector<double>{0.25, 0.125, 0.0625, 0.8125, 0.0625}));
}
