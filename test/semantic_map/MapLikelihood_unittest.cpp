#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "SmallMaps.h"
#include "TemporaryFolder.h"

using mrpt::poses::CPose3D;
using semantic_map::CSemanticOctoMap;
using semantic_types::ClassId;
using semantic_types::kNoClass;

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
    sum += p[k] * f.hitProbability * K * confusion;
  }
  return std::log(sum);
}

/** A return without a label knows two states: free and occupied. */
double expected(double occupancy, const semantic_octree::FilterParameters& f) {
  return std::log((1 - occupancy) * f.falseAlarmProbability + occupancy * f.hitProbability);
}

}  // namespace

TEST(MapLikelihood, isTheSensorModelsExpectationOverTheCell) {
  const CSemanticOctoMap map = mapOfOnePoint();
  const auto node = map.tree().search(map.tree().coordToKey(3.05, 0.05, 0.05));
  const auto free = map.tree().search(map.tree().coordToKey(1.05, 0.01, 0.01));
  ASSERT_TRUE(node && free);
  const auto& f = map.tree().filterParameters();
  const Eigen::Vector3f missed(1.05f, 0.01f, 0.01f), unknown(0, 0, 50);
  EXPECT_NEAR(logLikelihood(map, kSeen, kNoClass), expected(node->getOccupancy(), f), 1e-6);
  EXPECT_NEAR(logLikelihood(map, missed, kNoClass), expected(free->getOccupancy(), f), 1e-6);
  EXPECT_NEAR(logLikelihood(map, unknown, kNoClass), expected(0.5, f), 1e-6);
  for (const ClassId id : {1, 2, 3}) {
    EXPECT_NEAR(logLikelihood(map, kSeen, id), expected(map.tree().distribution(*node), id, f),
                1e-6);
    EXPECT_NEAR(logLikelihood(map, missed, id), expected(map.tree().distribution(*free), id, f),
                1e-6);
    EXPECT_NEAR(logLikelihood(map, unknown, id), expected({0.5, 0.5 / 3, 0.5 / 3, 0.5 / 3}, id, f),
                1e-6);
  }
  CSemanticOctoMap withoutLabels = map;
  withoutLabels.likelihoodOptions.useLabels = false;
  EXPECT_EQ(logLikelihood(withoutLabels, kSeen, 2), logLikelihood(map, kSeen, kNoClass));
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

TEST(MapLikelihood, beamsThatPassCountTooWhereAsked) {
  CSemanticOctoMap map = mapOfOnePoint();
  const auto& f = map.tree().filterParameters();
  const auto passing = [&](double x) {
    const double occupied = map.tree().query(x, 0.01, 0.01).occupancy;
    return 1 - occupied * f.hitProbability - (1 - occupied) * f.falseAlarmProbability;
  };
  map.likelihoodOptions.beamStep = 1;
  const double end = std::log(0.5 * (f.hitProbability + f.falseAlarmProbability));
  EXPECT_NEAR(logLikelihood(map, {2.4f, 0.04f, 0.04f}, kNoClass),
              std::log(passing(0.5)) + std::log(passing(1.5)) + std::log(1 - passing(2.4)), 1e-6);
  // At 3.5 m it would have to come through the wall's voxel at 3 m.
  map.likelihoodOptions.beamStep = 2.03;
  EXPECT_NEAR(logLikelihood(map, {3.9f, 0.06f, 0.06f}, kNoClass),
              std::log(passing(1.015)) + std::log(passing(3.045)) + end, 1e-6);
}

TEST(MapLikelihood, rangesAreLimitedAsForInsertion) {
  CSemanticOctoMap map = mapOfOnePoint();
  map.insertionOptions.scan.maxRange = 2;
  EXPECT_EQ(logLikelihood(map, kSeen, 2), 0);
  map.likelihoodOptions.beamStep = 4;
  const double free = map.tree().query(2, 0.03, 0.03).occupancy;
  EXPECT_EQ(logLikelihood(map, kSeen, 2), 0);
  map.likelihoodOptions.beamStep = 3.8;
  const auto& f = map.tree().filterParameters();
  EXPECT_NEAR(logLikelihood(map, kSeen, 2),
              std::log(1 - free * f.hitProbability - (1 - free) * f.falseAlarmProbability), 1e-6);
  map.insertionOptions.scan.minRange = 4;
  EXPECT_EQ(logLikelihood(map, kSeen, 2), 0);
}

TEST(MapLikelihood, anObservationThatChangedIsSeenAnew) {
  const CSemanticOctoMap map = mapOfOnePoint();
  auto observation = labeledPoints({kSeen}, {2});
  const auto ask = [&] { return map.computeObservationLikelihood(observation, CPose3D()); };
  // Copies remember no observation.
  const double first = ask();
  EXPECT_EQ(ask(), first);
  observation.cloud.classes[0] = 1;
  EXPECT_NEAR(ask(), logLikelihood(CSemanticOctoMap(map), kSeen, 1), 1e-12);
  observation.cloud.points[0].z() += 50;
  EXPECT_NEAR(ask(), logLikelihood(CSemanticOctoMap(map), observation.cloud.points[0], 1), 1e-12);
  observation.sensorPose.z(-50);
  EXPECT_NEAR(ask(), logLikelihood(CSemanticOctoMap(map), kSeen, 1), 1e-12);
  observation.cloud = labeledPoints({kSeen}, {2}).cloud;
  observation.sensorPose = {};
  EXPECT_EQ(ask(), first);
}

TEST(MapLikelihood, severalThreadsGetTheSameAnswers) {
  CSemanticOctoMap map(0.1, threeClasses());
  fill(map);
  const auto one = labeledPoints({{1, 2, 0}, {3, -1, 0}}, {1, 2});
  const auto other = labeledPoints({{-2, 2, 1}, {0, 1, 0}}, {3, 0});
  const double ofOne = map.computeObservationLikelihood(one, CPose3D());
  const double ofOther = map.computeObservationLikelihood(other, CPose3D());
  std::atomic<int> wrong = 0;
  const auto ask = [&] {
    for (int i = 0; i < 500; ++i) {
      wrong += map.computeObservationLikelihood(one, CPose3D()) != ofOne;
      wrong += map.computeObservationLikelihood(other, CPose3D()) != ofOther;
    }
  };
  std::thread a(ask), b(ask), c(ask);
  a.join(), b.join(), c.join();
  EXPECT_EQ(wrong, 0);
}

TEST(MapLikelihood, observationsThatCannotBeUsedTellNothing) {
  CSemanticOctoMap map = mapOfOnePoint();
  map.logger().logging_enable_console_output = false;
  map.logger().logging_enable_keep_record = true;
  const auto expectNone = [&map](const mrpt::obs::CObservation& observation) {
    EXPECT_FALSE(map.canComputeObservationLikelihood(observation));
    EXPECT_EQ(map.computeObservationLikelihood(observation, CPose3D()), 0);
  };
  expectNone(mrpt::obs::CObservationOdometry());
  EXPECT_EQ(map.logger().getLogAsString(), "");
  expectNone(labeledPoints({}, {}));
  EXPECT_TRUE(contains(map.logger().getLogAsString(), "no point"));
  expectNone(labeledPoints({kSeen}, {9}));
  EXPECT_TRUE(contains(map.logger().getLogAsString(), "class"));
  expectNone(mrpt::obs::CObservation3DRangeScan());
  EXPECT_TRUE(map.canComputeObservationLikelihood(labeledPoints({kSeen}, {2})));
}
