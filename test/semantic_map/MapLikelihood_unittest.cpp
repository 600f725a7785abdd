#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "SmallMaps.h"

using mrpt::poses::CPose3D;
using semantic_map::CSemanticOctoMap;
using semantic_octree::ClassId;
using semantic_octree::kNoClass;

namespace {

const Eigen::Vector3f kSeen(3.05f, 0.05f, 0.05f);

CSemanticOctoMap mapOfOnePoint() {
  CSemanticOctoMap map(0.1, threeClasses());
  map.likelihoodOptions.decimation = 1;
  map.insertObservation(labeledPoints({kSeen}, {2}));
  return map;
}

double logLikelihood(const CSemanticOctoMap& map, const Eigen::Vector3f& point, ClassId id) {
  return map.computeObservationLikelihood(labeledPoints({point}, {id}), CPose3D());
}

/** sum over the states of the cell of p(state) p(return, label | state), term by term. */
double expected(const std::vector<double>& p, ClassId label,
                const semantic_octree::FilterParameters& f) {
  const int K = static_cast<int>(p.size()) - 1;
  double sum = p[0] * f.falseAlarmProbability;
  for (int k = 1; k <= K; ++k) {
    const double confusion = k == label ? f.accuracy : (1 - f.accuracy) / (K - 1);
    sum += p[k] * f.hitProbability * (label == kNoClass ? 1 : K * confusion);
  }
  return std::log(sum);
}

}  // namespace

TEST(MapLikelihood, isTheSensorModelsExpectationOverTheCell) {
  const CSemanticOctoMap map = mapOfOnePoint();
  const auto* node = map.tree().search(map.tree().coordToKey(3.05, 0.05, 0.05));
  const auto* free = map.tree().search(map.tree().coordToKey(1.05, 0.01, 0.01));
  ASSERT_TRUE(node && free);
  const auto& f = map.tree().filterParameters();
  for (const ClassId id : {0, 1, 2, 3}) {
    EXPECT_NEAR(logLikelihood(map, kSeen, id), expected(map.tree().distribution(*node), id, f),
                1e-6);
    EXPECT_NEAR(logLikelihood(map, {1.05f, 0.01f, 0.01f}, id),
                expected(map.tree().distribution(*free), id, f), 1e-6);
    EXPECT_NEAR(logLikelihood(map, {0, 0, 50}, id),
                expected({0.5, 0.5 / 3, 0.5 / 3, 0.5 / 3}, id, f), 1e-6);
  }
}

TEST(MapLikelihood, theRightClassBeatsNoneAndNoneAWrongOne) {
  CSemanticOctoMap map = mapOfOnePoint();
  EXPECT_GT(logLikelihood(map, kSeen, 2), logLikelihood(map, kSeen, kNoClass));
  EXPECT_GT(logLikelihood(map, kSeen, kNoClass), logLikelihood(map, kSeen, 1));
  EXPECT_GT(logLikelihood(map, kSeen, kNoClass), logLikelihood(map, {0, 0, 50}, kNoClass));
  EXPECT_GT(logLikelihood(map, {0, 0, 50}, kNoClass), logLikelihood(map, {1.05f, 0.01f, 0.01f}, 0));
  map.likelihoodOptions.useLabels = false;
  EXPECT_EQ(logLikelihood(map, kSeen, 2), logLikelihood(map, kSeen, 1));
}

TEST(MapLikelihood, softLabelsLieBetweenTheHardOnes) {
  const CSemanticOctoMap map = mapOfOnePoint();
  auto soft = labeledPoints({kSeen}, {});
  const auto with = [&](std::vector<float> q) {
    soft.cloud.probabilities = std::move(q);
    return map.computeObservationLikelihood(soft, CPose3D());
  };
  EXPECT_NEAR(with({0, 1, 0}), logLikelihood(map, kSeen, 2), 1e-12);
  EXPECT_NEAR(with({0, 0, 0}), logLikelihood(map, kSeen, kNoClass), 1e-12);
  EXPECT_NEAR(std::exp(with({0.5, 0.5, 0})),
              (std::exp(logLikelihood(map, kSeen, 1)) + std::exp(logLikelihood(map, kSeen, 2))) / 2,
              1e-12);
}

TEST(MapLikelihood, pointsAddUpByDecimationAndWeight) {
  CSemanticOctoMap map = mapOfOnePoint();
  const auto three = labeledPoints({kSeen, {0, 0, 50}, kSeen}, {2, 2, 2});
  const double seen = logLikelihood(map, kSeen, 2), unknown = logLikelihood(map, {0, 0, 50}, 2);
  EXPECT_NEAR(map.computeObservationLikelihood(three, CPose3D()), 2 * seen + unknown, 1e-12);
  map.likelihoodOptions.decimation = 2;
  EXPECT_NEAR(map.computeObservationLikelihood(three, CPose3D()), 2 * seen, 1e-12);
  map.likelihoodOptions.pointWeight = 0.25;
  EXPECT_NEAR(map.computeObservationLikelihood(three, CPose3D()), seen / 2, 1e-12);
}

TEST(MapLikelihood, theTruePoseIsLikelierThanItsSurroundings) {
  CSemanticOctoMap map(0.1, threeClasses());
  fill(map);
  std::vector<Eigen::Vector3f> points;
  std::vector<ClassId> classes;
  for (int i = 0; i < 400; i += 3) {
    const float angle = 0.1f * float(i);
    points.emplace_back(5 * std::cos(angle), 4 * std::sin(angle), 0.01f * float(i) - 1);
    classes.push_back(static_cast<ClassId>(i % 4));
  }
  const auto observation = labeledPoints(points, classes);
  map.likelihoodOptions.decimation = 1;
  const auto at = [&](double x, double yaw) {
    return map.computeObservationLikelihood(observation, CPose3D(x, 0.2, 1, yaw, 0, 0));
  };
  EXPECT_GT(at(0.3, 0.5), at(0.6, 0.5));
  EXPECT_GT(at(0.3, 0.5), at(0.0, 0.5));
  EXPECT_GT(at(0.3, 0.5), at(0.3, 0.6));
}

TEST(MapLikelihood, otherObservationsHaveNone) {
  const CSemanticOctoMap map = mapOfOnePoint();
  EXPECT_FALSE(map.canComputeObservationLikelihood(mrpt::obs::CObservationOdometry()));
  EXPECT_TRUE(map.canComputeObservationLikelihood(labeledPoints({}, {})));
  EXPECT_EQ(map.computeObservationLikelihood(mrpt::obs::CObservationOdometry(), CPose3D()), 0);
}
