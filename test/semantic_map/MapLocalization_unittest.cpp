#include <gtest/gtest.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <semantic_types/ClassTable.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "SmallMaps.h"

using labeled_cloud::CObservationLabeledCloud;
using mrpt::poses::CPose3D;
using semantic_map::CSemanticOctoMap;

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
