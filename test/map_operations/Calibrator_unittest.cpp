// What labels are worth, from labels alone, and what maps state then.
#include <gtest/gtest.h>
#include <map_operations/Calibrator.h>
#include <map_operations/MapOperations.h>
#include <semantic_octree/store/CalibrationFit.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "LabelProcess.h"

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
  Calibrator calibrator(1, kFloorClasses);
  for (int i = 0; i < scans; ++i) {
    const LabeledCloud cloud = floor.scan();
    calibrator.add(cloud, Eigen::Isometry3d::Identity());
    f.map.insert(cloud, Eigen::Isometry3d::Identity());
  }
  f.calibration = calibrator.fit(f.map);
  return f;
}

/** Voxels of one class each, by turns; labels repeat the one before, or are right, or the next
 * class. */
LabeledVoxels labeledVoxels(int number, int labels, double repeated, double right) {
  std::mt19937 random(3);
  std::uniform_real_distribution<> uniform(0, 1);
  LabeledVoxels voxels;
  for (int v = 0; v < number; ++v) {
    std::string all;
    for (int i = 0; i < labels; ++i) {
      const int id = 1 + (v % 3 + (uniform(random) < right ? 0 : 1)) % 3;
      all.push_back(i > 0 && uniform(random) < repeated ? all.back() : static_cast<char>(id));
    }
    ++voxels[all];
  }
  return voxels;
}

double share(const std::vector<double>& row, int column) {
  return row[column - 1] / std::accumulate(row.begin(), row.end(), 0.0);
}

/** Voxels of two classes; scans take class 1 for 3 in 40 of 100 cases, class 2 for nothing else. */
std::vector<std::vector<double>> confusionOf(int scans, int voxels) {
  std::mt19937 random(5);
  Calibrator calibrator(0.5, kFloorClasses);
  for (int s = 0; s < scans; ++s) {
    LabeledCloud cloud;
    for (int v = 0; v < voxels; ++v) {
      const bool errs = v % 2 == 0 && std::uniform_real_distribution<>(0, 1)(random) < 0.4;
      for (const float dx : {0.1f, 0.2f, 0.3f}) {
        cloud.points.emplace_back(0.5f * static_cast<float>(v - voxels / 2) + dx, 0.1f, 0.1f);
        cloud.classes.push_back(static_cast<ClassId>(v % 2 == 1 ? 2 : errs ? 3 : 1));
      }
    }
    calibrator.add(cloud, Eigen::Isometry3d::Identity());
  }
  return calibrator.confusion(0.9);
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
    EXPECT_TRUE(fit(floor, 2).calibration.isIdentity());
  }
}

TEST(Calibrator, holdsToTheMapsCalibrationUntilLabelsSpeakAgainstIt) {
  Floor floor(0, true);
  SemanticOcTree map = floor.map();
  map.setCalibration({0.5, 0.5});
  Calibrator calibrator(1, kFloorClasses);
  for (int scans = 0; scans < 3; ++scans) {
    EXPECT_EQ(calibrator.fit(map).power, 0.5);
    EXPECT_EQ(calibrator.fit(map).shared, 0.5);
    map.insert(floor.scan(), Eigen::Isometry3d::Identity());
    calibrator.add(floor.scan(), Eigen::Isometry3d::Identity());
  }
  EXPECT_GT(calibrator.fit(map).power, 0.5);
  calibrator.clear();
  EXPECT_EQ(calibrator.fit(map).power, 0.5);
}

TEST(Calibrator, takesSoftLabelsForTheirLikeliestClasses) {
  Floor floor(0.45, true);
  SemanticOcTree map = floor.map();
  Calibrator hard(1, kFloorClasses), soft(1, kFloorClasses);
  for (int i = 0; i < 8; ++i) {
    const LabeledCloud cloud = floor.scan();
    LabeledCloud rows = cloud;
    rows.classes.clear();
    rows.probabilities.assign(cloud.size() * kFloorClasses, 0.05f);
    for (std::size_t p = 0; p < cloud.size(); ++p)
      rows.probabilities[p * kFloorClasses + cloud.classes[p] - 1] = 0.65f;
    hard.add(cloud, Eigen::Isometry3d::Identity());
    soft.add(rows, Eigen::Isometry3d::Identity());
    map.insert(cloud, Eigen::Isometry3d::Identity());
  }
  EXPECT_EQ(soft.fit(map).power, hard.fit(map).power);
  EXPECT_EQ(soft.fit(map).shared, hard.fit(map).shared);
  EXPECT_FALSE(hard.fit(map).isIdentity());
}

TEST(Calibrator, refusesLabelsOfAnotherNumberOfPoints) {
  LabeledCloud cloud = Floor(0, true).scan();
  cloud.classes.pop_back();
  Calibrator calibrator(1, kFloorClasses);
  EXPECT_THROW(calibrator.add(cloud, Eigen::Isometry3d::Identity()), std::invalid_argument);
}

TEST(Calibrator, findsWhatIsTakenForWhat) {
  for (const int voxels : {4000, 150'000}) {  // more than it keeps
    const auto counts = confusionOf(7, voxels);
    EXPECT_NEAR(share(counts[0], 3), 0.4, 0.06) << voxels;
    EXPECT_NEAR(share(counts[0], 1), 0.6, 0.06) << voxels;
    EXPECT_GT(share(counts[1], 2), 0.97) << voxels;
    EXPECT_NEAR(share(counts[4], 5), 0.9, 0.02) << voxels;  // never seen
    double labels = 0;
    for (const auto& row : counts) labels += std::accumulate(row.begin(), row.end(), 0.0);
    EXPECT_LT(labels, 7 * 32768 + 1000 * kFloorClasses) << voxels;
  }
}

TEST(Calibrator, knowsNoConfusionWithoutVoxelsThatSeveralScansSaw) {
  for (const auto& counts : {confusionOf(1, 4000), confusionOf(0, 0)})
    for (int k = 1; k <= kFloorClasses; ++k)
      for (int l = 1; l <= kFloorClasses; ++l)
        EXPECT_NEAR(share(counts[k - 1], l), k == l ? 0.9 : 0.1 / 7, 1e-9);
}

TEST(Calibrator, leavesOutWhatIsTooFarOrHasNoLabel) {
  Calibrator calibrator(0.5, kFloorClasses);
  LabeledCloud cloud;
  cloud.points = {{1, 0, 0}, {9, 0, 0}, {3, 0, 0}, {NAN, 0, 0}};
  cloud.classes = {1, 1, 0, 1};
  InsertionOptions options;
  options.minRange = 2;
  options.maxRange = 5;
  for (int s = 0; s < 1000; ++s) calibrator.add(cloud, Eigen::Isometry3d::Identity(), options);
  EXPECT_NEAR(share(calibrator.confusion(0.9)[0], 1), 0.9, 1e-9);
}

TEST(LabelProcess, findsHowOftenScansRepeatTheOneBefore) {
  for (const double repeated : {0.0, 0.3, 0.6}) {
    const LabelProcess process(labeledVoxels(20'000, 6, repeated, 0.8), 3, 0.9, 20);
    EXPECT_NEAR(process.repeated(), repeated, 0.03);
    const double least = 1 - (1 - process.repeated()) * (1 - process.repeated());
    EXPECT_GE(process.correlation(), least);
    EXPECT_LE(process.correlation(), std::max(0.03, least));
  }
}

TEST(LabelProcess, findsWhatVoxelsAre) {
  const LabelProcess process(labeledVoxels(20'000, 6, 0, 0.8), 3, 0.9, 20);
  EXPECT_NEAR(share(process.counts()[0], 1), 0.8, 0.02);
  EXPECT_GT(process.classesOf({1, 1, 2, 1})[0], 0.95);
  EXPECT_GT(process.classesOf({2, 3, 2, 3})[1], 0.6);  // 3 is taken for 1, not for 2
}

TEST(LabelProcess, isLessSureWhereScansRepeatEachOther) {
  const std::string same{1, 1, 1, 1}, other{1, 1, 1, 2};
  const LabelProcess apart(labeledVoxels(20'000, 6, 0, 0.7), 3, 0.9, 20),
      repeating(labeledVoxels(20'000, 6, 0.5, 0.7), 3, 0.9, 20);
  EXPECT_LT(repeating.classesOf(same)[0], apart.classesOf(same)[0]);
  EXPECT_LT(repeating.classesOf(other)[0], apart.classesOf(other)[0]);
}

TEST(LabelProcess, seesVoxelsOfSeveralClassesInLabelsThatDiffer) {
  LabeledVoxels voxels = labeledVoxels(20'000, 6, 0, 0.99);
  std::mt19937 random(8);
  for (int v = 0; v < 1000; ++v) {
    std::string labels;
    for (int i = 0; i < 6; ++i) labels.push_back(static_cast<char>(1 + random() % 2));
    ++voxels[labels];
  }
  EXPECT_GT(LabelProcess(voxels, 3, 0.9, 20).correlation(), 0.2);
  EXPECT_LT(LabelProcess(labeledVoxels(20'000, 6, 0, 0.8), 3, 0.9, 20).correlation(), 0.03);
}

TEST(ExactExponential, isTheExponential) {
  for (double x = 0; x > -690; x -= 0.37)
    EXPECT_NEAR(exactExponential(x) / std::exp(x), 1, 1e-13) << x;
  EXPECT_EQ(exactExponential(0), 1);
  EXPECT_EQ(exactExponential(-701), 0);
}

// Found on x86-64; other processors and standard libraries have to agree to the last bit.
TEST(ExactExponential, hasTheSameBitsEverywhere) {
  EXPECT_EQ(exactExponential(-1), 0x1.78b56362cef38p-2);
  EXPECT_EQ(exactExponential(-10.3), 0x1.1a22859e0dc33p-15);
  EXPECT_EQ(exactExponential(-0.001), 0x1.ff7cfe56f1a9ep-1);
}

TEST(LabelProcess, hasTheSameBitsEverywhere) {
  LabeledVoxels voxels;
  for (int v = 0; v < 3000; ++v) {  // no generator or distribution of the library's
    std::string labels;
    for (int i = 0; i < 5; ++i) {
      const int id = 1 + (v % 3 + (v * (i + 7) * 7919 % 101 < 20)) % 3;
      const bool again = i > 0 && v * (i + 3) * 1047 % 97 < 30;
      labels.push_back(again ? labels.back() : static_cast<char>(id));
    }
    ++voxels[labels];
  }
  const LabelProcess process(voxels, 3, 0.9, 20);
  EXPECT_EQ(process.repeated(), 0x1.07d7e22b75a64p-2);
  EXPECT_EQ(process.correlation(), 0x1.cbb472262d298p-2);
  EXPECT_EQ(process.counts()[0][0], 0x1.78542db417d11p+10);
  EXPECT_EQ(process.classesOf({1, 2, 2})[0], 0x1.fba9e511a29a1p-1);
}

TEST(LabelProcess, takesNoClassForAnotherIfLabelsAreThoughtToBeRightAtFirst) {
  // Three labels in ten of class 1, which is frequent, name 2 or 3; class 3 is taken for 2.
  LabeledVoxels voxels;
  std::mt19937 random(5);
  for (int v = 0; v < 4300; ++v) {
    std::string labels;
    for (int i = 0; i < 4; ++i) {
      const auto percent = random() % 100;
      const int rare = percent < 65 ? 3 : 2, frequent = percent < 70 ? 1 : 2 + v % 2;
      labels.push_back(static_cast<char>(v < 300 ? rare : frequent));
    }
    ++voxels[labels];
  }
  EXPECT_LT(LabelProcess(voxels, 4, 0.93, 20).classesOf({1, 1, 1})[0], 0.7);
  EXPECT_GT(LabelProcess(voxels, 4, 0.93, 20, 1000).classesOf({1, 1, 1})[0], 0.95);
}

TEST(LabelProcess, findsTheFrequentOfTwoClassesThatAreTakenForEachOther) {
  // Class 1 is taken for 2 in two of five cases, nothing is of class 2.
  LabeledVoxels voxels;
  std::mt19937 random(5);
  for (int v = 0; v < 8000; ++v) {
    std::string labels;
    for (int i = 0; i < 5; ++i) {
      const auto percent = random() % 100;
      labels.push_back(percent < 52 ? 1 : percent < 92 ? 2 : 3);
    }
    ++voxels[labels];
  }
  EXPECT_GT(LabelProcess(voxels, 4, 0.93, 20, 1000).classesOf({2, 2, 2, 1, 1})[0], 0.95);
}

TEST(Calibrator, makesSumsAsCautiousAsTheMostCautiousOfTheirMaps) {
  Floor floor(0, true);
  SemanticOcTree a = floor.map(), b = floor.map(), withoutLabels = floor.map();
  LabeledCloud cloud = floor.scan();
  for (SemanticOcTree* map : {&a, &b}) map->insert(cloud, Eigen::Isometry3d::Identity());
  cloud.classes.clear();
  withoutLabels.insert(cloud, Eigen::Isometry3d::Identity());
  a.setCalibration({0.5, 0.1});
  b.setCalibration({0.8, 0.3});
  for (const auto& maps : {std::vector<const SemanticOcTree*>{&a, &b}, {&b, &a}}) {
    const SemanticOcTree sum = merged(maps);
    EXPECT_EQ(sum.filterParameters().calibration.power, 0.5);
    EXPECT_EQ(sum.filterParameters().calibration.shared, 0.3);
    EXPECT_TRUE(sum.filterParameters().calibration.factors.empty());
  }
  a.setCalibration({1, 0, {2, 3, 2, 0.5, 0.2, 1, 1, 1}});
  b.setCalibration({1, 0, {4, 2, 0.5, 2, 0.1, 3, 1, 0.5}});
  const std::vector<double> nextToOne{2, 2, 1, 1, 0.2, 1, 1, 1};
  EXPECT_EQ(merged({&a, &b}).filterParameters().calibration.factors, nextToOne);
  EXPECT_EQ(merged({&b, &a}).filterParameters().calibration.factors, nextToOne);
  b.setCalibration({});
  for (const auto& maps : {std::vector<const SemanticOcTree*>{&a, &b}, {&b, &a}})
    EXPECT_TRUE(merged(maps).filterParameters().calibration.factors.empty());
  EXPECT_EQ(merged({&a, &withoutLabels}).filterParameters().calibration.factors.size(), 8U);
  EXPECT_EQ(merged({&withoutLabels, &a}).filterParameters().calibration.factors.size(), 8U);
}
