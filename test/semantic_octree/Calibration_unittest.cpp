// What is stated of a belief.
#include <gtest/gtest.h>
#include <semantic_octree/SemanticOcTree.h>

#include <cmath>

#include "ExactFilter.h"

using namespace semantic_octree;

namespace {

constexpr int kSevenClasses = 7;

ClassFilter filterOf(double power, double shared) {
  FilterParameters parameters;
  parameters.calibration = {power, shared};
  return {kSevenClasses, parameters};
}

/** Two classes were seen. */
ClassBelief someBelief() {
  const ClassFilter filter(kSevenClasses, {});
  ClassBelief belief = filter.uniform(0);
  for (const ClassId id : {4, 2, 4}) filter.hit(belief, id);
  return belief;
}

/** p(class | occupied), [0] is free. */
std::vector<double> classesOf(const ClassBelief& belief) {
  std::vector<double> p(kSevenClasses + 1);
  belief.distribution(kSevenClasses, p.data());
  for (int k = 1; k <= kSevenClasses; ++k) p[k] /= 1 - p[0];
  return p;
}

}  // namespace

TEST(Calibration, isAPowerAndWhatNamedClassesShare) {
  const ClassBelief belief = someBelief();
  const auto p = classesOf(belief);
  for (const double power : {1.0, 0.6, 0.2})
    for (const double shared : {0.0, 0.3}) {
      const ClassBelief stated = filterOf(power, shared).stated(belief);
      double sum = 0;
      for (int k = 1; k <= kSevenClasses; ++k) sum += std::pow(p[k], power);
      const auto s = classesOf(stated);
      for (int k = 1; k <= kSevenClasses; ++k) {
        const double named = k == 2 || k == 4 ? shared / 2 : 0;
        EXPECT_NEAR(s[k], (1 - shared) * std::pow(p[k], power) / sum + named, kTick) << k;
      }
      EXPECT_NEAR(stated.occupancyLogOdds(kSevenClasses), belief.occupancyLogOdds(kSevenClasses),
                  kTick);
      EXPECT_EQ(stated.ids, belief.ids);
    }
  EXPECT_TRUE(filterOf(1, 0).stated(belief) == belief);
  EXPECT_TRUE(filterOf(0.3, 0.3).stated(filterOf(1, 0).uniform(1)) == filterOf(1, 0).uniform(1));
}

TEST(Calibration, hasFactorsOfClasses) {
  const ClassBelief belief = someBelief();
  const auto p = classesOf(belief);
  FilterParameters parameters;
  parameters.calibration = {0.6, 0.3, {2, 0.25, 300, 0.5, 4, 0.01, 1}};
  const std::vector<double>& w = parameters.calibration.factors;
  const ClassFilter filter(kSevenClasses, parameters);
  double sum = 0;
  for (int k = 1; k <= kSevenClasses; ++k) sum += w[k - 1] * std::pow(p[k], 0.6);
  std::vector<double> expected(kSevenClasses + 1), all(kSevenClasses + 1);
  for (int k = 1; k <= kSevenClasses; ++k)
    expected[k] = 0.7 * w[k - 1] * std::pow(p[k], 0.6) / sum + (k == 2 || k == 4 ? 0.15 : 0);
  filter.distribution(belief, all.data());
  const ClassBelief stated = filter.stated(belief);
  const auto s = classesOf(stated);
  EXPECT_EQ(stated.ids, (std::array<ClassId, 3>{3, 4, 2}));  // 3 is not named, but frequent
  const double others = (expected[1] + expected[5] + expected[6] + expected[7]) / 4;
  for (int k = 1; k <= kSevenClasses; ++k) {
    EXPECT_NEAR(all[k] / (1 - all[0]), expected[k], kTick) << k;
    EXPECT_NEAR(s[k], k >= 2 && k <= 4 ? expected[k] : others, kTick) << k;
  }
  EXPECT_NEAR(stated.occupancyLogOdds(kSevenClasses), belief.occupancyLogOdds(kSevenClasses),
              kTick);
  EXPECT_TRUE(filter.stated(filter.uniform(1)) == filter.uniform(1));
}

TEST(Calibration, isOfWhatMapsStateAndNotOfTheirBeliefs) {
  ClassTable classes;
  for (int i = 1; i <= kSevenClasses; ++i) classes.add("class " + std::to_string(i), {});
  SemanticOcTree map(1, classes);
  LabeledCloud cloud;
  cloud.points = {{2.5f, 0.5f, 0.5f}};
  for (const ClassId id : {4, 4, 2}) {
    cloud.classes = {id};
    map.insert(cloud, Eigen::Isometry3d::Identity());
  }
  const SemanticOcTree before = map;
  const CellState was = before.query(2.5, 0.5, 0.5);
  map.setCalibration({0.4, 0.2});
  const CellState is = map.query(2.5, 0.5, 0.5);
  EXPECT_LT(is.probability, was.probability - 0.05);
  EXPECT_EQ(is.likeliestClass, was.likeliestClass);
  EXPECT_EQ(is.occupancy, was.occupancy);
  const auto leaf = map.search(map.coordToKey(2.5, 0.5, 0.5));
  EXPECT_NEAR(map.distribution(leaf)[4], is.probability, 1e-12);
  EXPECT_NEAR(map.query(2.5, 0.5, 0.5, 10).probability, is.probability, 1e-3);
  EXPECT_TRUE(map == before);
  EXPECT_TRUE(map.belief(leaf) == before.belief(before.search(before.coordToKey(2.5, 0.5, 0.5))));
  EXPECT_EQ(emptyLike(map).filterParameters().calibration.power, 0.4);
  EXPECT_THROW(map.setCalibration({0, 0}), std::invalid_argument);
  EXPECT_THROW(map.setCalibration({4.5, 0}), std::invalid_argument);
  map.setCalibration({4, 0});
  EXPECT_GT(map.query(2.5, 0.5, 0.5).probability, was.probability);
  map.setCalibration({1, 0, {1, 30, 1, 1, 1, 1, 1}});
  EXPECT_EQ(map.query(2.5, 0.5, 0.5).likeliestClass, 2);
  EXPECT_TRUE(map == before);
  map.setCalibration({0.4, 0.2});
  for (const double bad : {0.0, -1.0, 1e-6, 1e6, double(NAN), HUGE_VAL})
    EXPECT_THROW(map.setCalibration({0.5, 0, {1, 1, 1, 1, 1, 1, bad}}), std::invalid_argument);
  EXPECT_THROW(map.setCalibration({0.5, 0, {1, 1}}), std::invalid_argument);
  EXPECT_THROW(map.setCalibration({0.5, 1}), std::invalid_argument);
  EXPECT_EQ(map.filterParameters().calibration.power, 0.4);
}
