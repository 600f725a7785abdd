// What maps state, fitted to scans that they do not know yet.
#include <gtest/gtest.h>
#include <map_operations/Calibrator.h>
#include <map_operations/MapOperations.h>

#include <cmath>
#include <random>

using namespace semantic_octree;

namespace {

constexpr int kFloorClasses = 8, kFloorEdge = 48;

/** A floor of tiles of three classes under a sensor, seen again and again. */
class Floor {
 public:
  explicit Floor(double wrong, bool asOne) : m_wrong(wrong), m_asOne(asOne) {}

  /** What one scan says. Labels of a voxel are wrong as one, and then always the same class, or one
   * by one, and then any. */
  LabeledCloud scan() {
    LabeledCloud cloud;
    for (int x = 0; x < kFloorEdge; ++x)
      for (int y = 0; y < kFloorEdge; ++y) {
        ClassId label = labelOf(x, y);
        for (const float dx : {0.2f, 0.4f, 0.6f, 0.8f}) {
          cloud.points.emplace_back(x + dx, y + 0.5f, -9.5f);
          if (!m_asOne) label = labelOf(x, y);
          cloud.classes.push_back(label);
        }
      }
    return cloud;
  }
  SemanticOcTree map() const {
    ClassTable classes;
    for (int i = 1; i <= kFloorClasses; ++i) classes.add("class " + std::to_string(i), {});
    return {1, classes};
  }
  /** Mean of -ln p(true class | occupied). */
  double logLoss(const SemanticOcTree& map) const {
    double loss = 0;
    for (int x = 0; x < kFloorEdge; ++x)
      for (int y = 0; y < kFloorEdge; ++y) {
        const auto p = map.distribution(map.search(map.coordToKey(x + 0.5, y + 0.5, -9.5)));
        loss -= std::log(p[truth(x, y)] / (1 - p[0]));
      }
    return loss / (kFloorEdge * kFloorEdge);
  }

 private:
  static ClassId truth(int x, int y) { return static_cast<ClassId>(1 + (x / 4 + y / 4) % 3); }
  ClassId labelOf(int x, int y) {
    const ClassId id = truth(x, y);
    if (std::uniform_real_distribution<>(0, 1)(m_random) >= m_wrong) return id;
    const int to = m_asOne ? 3 : std::uniform_int_distribution<>(1, kFloorClasses - 1)(m_random);
    return static_cast<ClassId>(1 + (id - 1 + to) % kFloorClasses);
  }

  double m_wrong;
  bool m_asOne;
  std::mt19937 m_random{7};
};

struct Fitted {
  SemanticOcTree map;
  Calibration calibration;
};

Fitted fit(Floor& floor, int scans) {
  Fitted f{floor.map(), {}};
  Calibrator calibrator;
  for (int i = 0; i < scans; ++i) {
    const LabeledCloud cloud = floor.scan();
    calibrator.ask(f.map, cloud, Eigen::Isometry3d::Identity());
    f.map.insert(cloud, Eigen::Isometry3d::Identity());
  }
  f.calibration = calibrator.best();
  return f;
}

}  // namespace

TEST(Calibrator, makesTheTruthLikelierWhereVoxelsErrAsAWhole) {
  for (const double wrong : {0.3, 0.45}) {
    Floor floor(wrong, true);
    auto [map, calibration] = fit(floor, 8);
    const double before = floor.logLoss(map);
    map.setCalibration(calibration);
    EXPECT_LT(floor.logLoss(map), 0.9 * before) << calibration.power << ' ' << calibration.shared;
  }
}

TEST(Calibrator, leavesMapsSureWhoseLabelsErrOneByOne) {
  Floor floor(0.3, false);
  auto [map, calibration] = fit(floor, 8);
  const double before = floor.logLoss(map);
  map.setCalibration(calibration);
  EXPECT_GE(calibration.power, 0.7);
  EXPECT_LT(floor.logLoss(map), 1.2 * before + 0.01);
}

TEST(Calibrator, leavesWhatFewScansSaw) {
  for (const bool asOne : {false, true}) {
    Floor floor(0.7, asOne);
    EXPECT_TRUE(fit(floor, 3).calibration.isIdentity());
  }
  EXPECT_TRUE(Calibrator().best().isIdentity());
}

TEST(Calibrator, holdsToTheMapsCalibrationUntilLabelsSpeakAgainstIt) {
  Floor floor(0, true);
  SemanticOcTree map = floor.map();
  map.setCalibration({0.5, 0.5});
  Calibrator calibrator;
  calibrator.ask(map, floor.scan(), Eigen::Isometry3d::Identity());
  EXPECT_EQ(calibrator.best().power, 0.5);
  EXPECT_EQ(calibrator.best().shared, 0.5);
}

TEST(Calibrator, asksWithSoftLabelsAsWithTheClassesThatTheyAre) {
  Floor floor(0.45, true);
  SemanticOcTree map = floor.map();
  Calibrator hard, soft;
  for (int i = 0; i < 8; ++i) {
    const LabeledCloud cloud = floor.scan();
    LabeledCloud rows = cloud;
    rows.classes.clear();
    rows.probabilities.assign(cloud.size() * kFloorClasses, 0.f);
    for (std::size_t p = 0; p < cloud.size(); ++p)
      rows.probabilities[p * kFloorClasses + cloud.classes[p] - 1] = 1;
    hard.ask(map, cloud, Eigen::Isometry3d::Identity());
    soft.ask(map, rows, Eigen::Isometry3d::Identity());
    map.insert(cloud, Eigen::Isometry3d::Identity());
  }
  EXPECT_EQ(soft.best().power, hard.best().power);
  EXPECT_EQ(soft.best().shared, hard.best().shared);
  EXPECT_FALSE(hard.best().isIdentity());
}

TEST(Calibrator, refusesLabelsOfAnotherNumberOfPoints) {
  Floor floor(0, true);
  const SemanticOcTree map = floor.map();
  LabeledCloud cloud = floor.scan();
  cloud.classes.pop_back();
  Calibrator calibrator;
  EXPECT_THROW(calibrator.ask(map, cloud, Eigen::Isometry3d::Identity()), std::invalid_argument);
}

TEST(Calibrator, makesSumsAsCautiousAsTheMostCautiousOfTheirMaps) {
  Floor floor(0, true);
  SemanticOcTree a = floor.map(), b = floor.map();
  a.setCalibration({0.5, 0.1});
  b.setCalibration({0.8, 0.3});
  for (const auto& maps : {std::vector<const SemanticOcTree*>{&a, &b}, {&b, &a}}) {
    const SemanticOcTree sum = merged(maps);
    EXPECT_EQ(sum.filterParameters().calibration.power, 0.5);
    EXPECT_EQ(sum.filterParameters().calibration.shared, 0.3);
  }
}
