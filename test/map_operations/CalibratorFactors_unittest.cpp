// Which maps have a factor for each class.
#include <gtest/gtest.h>
#include <map_operations/Calibrator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace semantic_octree;

namespace {

constexpr int kNumClasses = 8;

SemanticOcTree emptyMap() {
  ClassTable classes;
  for (int i = 1; i <= kNumClasses; ++i) classes.add("class " + std::to_string(i), {});
  return {1, classes};
}

/** Voxels in a row, one in ten of which is of class 2, the others of class 1. In each scan, two
 * in ten are taken for the other class. */
LabeledCloud rowOfVoxels(std::mt19937& random) {
  LabeledCloud cloud;
  for (int v = 0; v < 4000; ++v) {
    const bool saysRare = (v % 10 == 0) != (random() % 10 < 2);
    for (const float dx : {0.2f, 0.5f}) {
      cloud.points.emplace_back(static_cast<float>(v - 2000) + dx, 0.5f, 0.5f);
      cloud.classes.push_back(saysRare ? 2 : 1);
    }
  }
  return cloud;
}

struct RowOfVoxels {
  explicit RowOfVoxels(std::vector<float> prior = {}) : map(emptyMap()) {
    std::mt19937 random(11);
    map.setClassPrior(std::move(prior));
    Calibrator calibrator(1, kNumClasses);
    for (int i = 0; i < 4; ++i) {
      const LabeledCloud cloud = rowOfVoxels(random);
      calibrator.add(cloud, Eigen::Isometry3d::Identity());
      map.insert(cloud, Eigen::Isometry3d::Identity());
    }
    calibration = calibrator.fit(map);
  }
  /** Mean of -ln p(true class | occupied). */
  double logLoss(const Calibration& with) {
    map.setCalibration(with);
    double loss = 0;
    for (int v = 0; v < 4000; ++v) {
      const auto p = map.distribution(map.search(map.coordToKey(v - 2000 + 0.5, 0.5, 0.5)));
      loss -= std::log(p[v % 10 == 0 ? 2 : 1] / (1 - p[0])) / 4000;
    }
    return loss;
  }

  SemanticOcTree map;
  Calibration calibration;
};

}  // namespace

TEST(Calibrator, knowsWhichOfTwoClassesIsFrequentWhereLabelsErr) {
  RowOfVoxels row;
  const Calibration with = row.calibration;
  ASSERT_EQ(with.factors.size(), static_cast<std::size_t>(kNumClasses));
  EXPECT_LT(with.factors[1], 0.6 * with.factors[0]);
  EXPECT_LT(row.logLoss(with), 0.9 * row.logLoss({with.power, with.shared}));
  EXPECT_LT(row.logLoss(with), 0.9 * row.logLoss({}));
}

TEST(Calibrator, fitsNoFactorsWhereTheMapWasToldHowFrequentClassesAre) {
  EXPECT_TRUE(RowOfVoxels(std::vector<float>(kNumClasses, 0.125f)).calibration.factors.empty());
}

namespace {

/** A plain of fields of three classes, some of which are larger, seen by scans of some points a
 * voxel. Fields end within voxels. */
struct Plain {
  static constexpr int kEdge = 56;  // voxels

  explicit Plain(std::mt19937& r) : random(r) {
    for (double& edge : period) edge = 8 + 10 * uniform();
    for (double& x : shift) x = 20 * uniform();
    large = 0.5 + 0.3 * uniform();
    turn = uniform();
  }
  double uniform() { return std::uniform_real_distribution<>(0, 1)(random); }
  ClassId classAt(double x, double y) const {
    const auto isLarge = [this](double along, int axis) {
      const double t = along / period[axis] + shift[axis];
      return t - std::floor(t) < large;
    };
    const double u = x * std::cos(turn) + y * std::sin(turn),
                 v = y * std::cos(turn) - x * std::sin(turn);
    return isLarge(u, 0) ? 1 : isLarge(v, 1) ? 2 : 3;
  }
  /** \param wrong share of the labels that are of another class: one by one, or whole disks of the
   * scan. */
  LabeledCloud scan(double wrong, bool asDisks, int pointsOfVoxel) {
    LabeledCloud cloud;
    std::array<std::array<double, 2>, 12> disks;
    for (auto& center : disks) center = {kEdge * uniform(), kEdge * uniform()};
    const double squaredRadius = wrong * kEdge * kEdge / (M_PI * disks.size());
    for (int i = 0; i < kEdge * kEdge * pointsOfVoxel; ++i) {
      const double x = kEdge * uniform(), y = kEdge * uniform();
      const bool errs =
          asDisks
              ? std::any_of(disks.begin(), disks.end(),
                            [&](const auto& c) {
                              return std::pow(x - c[0], 2) + std::pow(y - c[1], 2) < squaredRadius;
                            })
              : uniform() < wrong;
      cloud.points.emplace_back(x, y, -2.5f);
      cloud.classes.push_back(1 + (classAt(x, y) - 1 + (errs ? 1 : 0)) % 3);
    }
    return cloud;
  }
  bool hasFactors(double wrong, bool asDisks, int scans, int pointsOfVoxel) {
    SemanticOcTree map = emptyMap();
    Calibrator calibrator(1, kNumClasses);
    for (int i = 0; i < scans; ++i) {
      const LabeledCloud cloud = scan(wrong, asDisks, pointsOfVoxel);
      calibrator.add(cloud, Eigen::Isometry3d::Identity());
      map.insert(cloud, Eigen::Isometry3d::Identity());
    }
    return !calibrator.fit(map).factors.empty();
  }

  std::mt19937& random;
  std::array<double, 2> period, shift;
  double large, turn;
};

}  // namespace

TEST(Calibrator, tellsLabelsThatErrFromBordersWithinVoxels) {
  std::mt19937 random(3);
  for (int i = 0; i < 8; ++i) {
    Plain plain(random);
    const int scans = 3 + i % 4, points = 1 + i % 3;
    const auto name = std::to_string(i) + ": fields of " + std::to_string(plain.period[0]);
    EXPECT_FALSE(plain.hasFactors(0, false, scans, points)) << name;
    EXPECT_TRUE(plain.hasFactors(0.15, false, scans, points)) << name;
    EXPECT_TRUE(plain.hasFactors(0.15, true, scans, points)) << name;
  }
}
