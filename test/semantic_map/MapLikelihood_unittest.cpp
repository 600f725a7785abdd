#include <gtest/gtest.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <semantic_types/ClassTable.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>
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

using labeled_cloud::CObservationLabeledCloud;

namespace {

/** A map of a part of the village's round, without one LiDAR scan of it, by which the robot is to
 * be found. */
struct Village {
  static constexpr int kFirst = 6, kLast = 12, kLeftOut = 9;

  CSemanticOctoMap map{
      0.2, semantic_types::loadClassTable(MSO_SOURCE_DIR "/config/classes/synthetic.yaml")};
  CPose3D T_map_robot;
  CObservationLabeledCloud::Ptr scan;

  Village() {
    map.insertionOptions.scan.maxRange = 30;
    labeled_cloud::RawlogReader rawlog(MSO_SOURCE_DIR "/rawlog-samples/village.rawlog");
    CPose3D pose;
    int frame = -1;
    while (const auto entry = rawlog.next())
      for (const auto& o : entry->observations) {
        const auto at = std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(o);
        if (at) pose = at->pose.mean, ++frame;
        if (at || frame < kFirst || frame > kLast) continue;
        const auto cloud = std::dynamic_pointer_cast<CObservationLabeledCloud>(o);
        if (frame == kLeftOut && cloud)
          scan = cloud, T_map_robot = pose;
        else
          map.insertObservation(*o, pose);
      }
  }
};

Village& village() {
  static Village v;
  return v;
}

/** A robot's place in the plane relative to the true one, in m and radians. */
struct Offset {
  double x = 0, y = 0, yaw = 0;
};

/** Particles around the true pose, weighed by the likelihood of the scan that the map lacks. */
class Particles {
 public:
  Particles(int seed, int count) : m_random(seed), m_offsets(count) {
    for (Offset& o : m_offsets) o = moved({}, 1, 10 * M_PI / 180);
  }

  /** Weighs them, draws as many anew, and spreads them a little. */
  void update(double spread) {
    std::vector<double> logs;
    for (const Offset& o : m_offsets) logs.push_back(logLikelihood(o));
    const double most = *std::max_element(logs.begin(), logs.end());
    for (double& l : logs) l = std::exp(l - most);
    std::discrete_distribution<std::size_t> draw(logs.begin(), logs.end());
    std::vector<Offset> next;
    while (next.size() < m_offsets.size())
      next.push_back(moved(m_offsets[draw(m_random)], spread, spread * 0.1));
    m_offsets = next;
  }

  double meters() const {
    const Offset m = mean();
    return std::hypot(m.x, m.y);
  }
  double degrees() const { return std::abs(mean().yaw) * 180 / M_PI; }

 private:
  Offset moved(const Offset& o, double meters, double radians) {
    std::normal_distribution<double> noise;
    return {o.x + meters * noise(m_random), o.y + meters * noise(m_random),
            o.yaw + radians * noise(m_random)};
  }
  static double logLikelihood(const Offset& o) {
    const Village& v = village();
    return v.map.computeObservationLikelihood(*v.scan,
                                              v.T_map_robot + CPose3D(o.x, o.y, 0, o.yaw, 0, 0));
  }
  Offset mean() const {
    Offset sum;
    for (const Offset& o : m_offsets) sum.x += o.x, sum.y += o.y, sum.yaw += o.yaw;
    const auto n = double(m_offsets.size());
    return {sum.x / n, sum.y / n, sum.yaw / n};
  }

  std::mt19937 m_random;
  std::vector<Offset> m_offsets;
};

struct Errors {
  double meters = 0, degrees = 0;  ///< at the end, mean over the seeds
  double onTheWay = 0;             ///< m, mean over steps and seeds
};

Errors localize(bool useLabels) {
  auto& options = village().map.likelihoodOptions;
  options = {};
  options.useLabels = useLabels;
  options.decimation = 30;
  options.pointWeight = 0.2;
  constexpr int kSeeds = 5, kSteps = 6;
  Errors errors;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Particles particles(seed, 150);
    for (int step = 0; step < kSteps; ++step) {
      particles.update(0.2 * std::pow(0.6, step));
      errors.onTheWay += particles.meters() / (kSeeds * kSteps);
    }
    errors.meters += particles.meters() / kSeeds;
    errors.degrees += particles.degrees() / kSeeds;
  }
  return errors;
}

}  // namespace

TEST(MapLocalization, spreadParticlesConvergeToTheTruePoseAndFasterWithLabels) {
  ASSERT_TRUE(village().scan);
  const Errors with = localize(true), without = localize(false);
  RecordProperty("with_labels_cm", int(100 * with.meters));
  RecordProperty("without_labels_cm", int(100 * without.meters));
  EXPECT_LT(with.meters, 0.1);
  EXPECT_LT(with.degrees, 0.5);
  EXPECT_LT(without.meters, 0.5);
  EXPECT_LT(with.onTheWay, without.onTheWay);
  EXPECT_LT(with.meters, without.meters);
}
