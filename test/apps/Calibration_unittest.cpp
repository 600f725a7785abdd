// Whether probabilities mean what they say, in a world whose truth is known.
#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>

#include "Evaluation.h"

using namespace semantic_octree;
using semantic_map_evaluate::Evaluation;

namespace {

constexpr int kScans = 40;

/** Even scans of a drive through the village, and what they are asked: the odd ones. */
class Village {
 public:
  explicit Village(double wrongLabels) : m_map(0.2, synthetic_world::classTable()) {
    for (int i = 0; i < kScans; i += 2) m_map.insert(scan(i, wrongLabels), pose(i));
  }

  SemanticOcTree& map() { return m_map; }

  Evaluation evaluate(const SemanticOcTree& map) const {
    const SmoothedView view(map, {0.0});
    Evaluation evaluation(map.numClasses());
    for (int i = 1; i < kScans; i += 2) {
      const LabeledCloud asked = scan(i, 0);
      for (std::size_t k = 0; k < asked.size(); ++k)
        if (asked.classes[k] != kNoClass)
          evaluation.ask(view, pose(i) * asked.points[k].cast<double>(), asked.classes[k]);
    }
    return evaluation;
  }

 private:
  Eigen::Isometry3d pose(int i) const {
    const Eigen::Vector2d p = m_scene.route.at(i);
    return m_scene.world.poseOnGround(p.x(), p.y(), m_scene.route.heading(i)) *
           Eigen::Translation3d(0, 0, 1.5);
  }
  LabeledCloud scan(int i, double wrongLabels) const {
    synthetic_world::LidarOptions lidar;
    lidar.maxRange = 25;
    lidar.noise.range = 0.02;
    lidar.noise.label = wrongLabels;
    return scanLidar(m_scene.world, pose(i), lidar, {1, static_cast<std::uint64_t>(i)});
  }

  synthetic_world::Scene m_scene = synthetic_world::makeScene("village", 1);
  SemanticOcTree m_map;
};

}  // namespace

TEST(Calibration, ofAMapIsRight) {
  for (const double wrongLabels : {0.0, 0.1, 0.3}) {
    Village village(wrongLabels);
    const Evaluation full = village.evaluate(village.map());
    EXPECT_LE(full.calibrationError(), 0.03) << wrongLabels;
    EXPECT_GE(full.answered(), 100'000u);
  }
}

TEST(Calibration, ofACompressedMapIsNearlyThatOfTheMap) {
  for (const double wrongLabels : {0.0, 0.1, 0.3}) {
    Village village(wrongLabels);
    AbstractionOptions options;
    options.weights.terms = {tree_abstraction::relevant("road", 1, {synthetic_world::kRoad})};
    options.weights.alpha = 0.005;
    options.blockSize = 3.2;
    setAbstraction(village.map(), options);
    const SemanticOcTree compressed = Abstraction(village.map()).compressedMap();
    const Evaluation e = village.evaluate(compressed);
    EXPECT_LT(compressed.getNumLeafNodes(), village.map().getNumLeafNodes() / 10);
    EXPECT_LE(e.calibrationError(), 0.1) << wrongLabels;
  }
}
