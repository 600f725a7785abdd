// A confusion matrix from labels alone.
#include <gtest/gtest.h>
#include <labeled_cloud/ConfusionEstimate.h>

#include <random>

using namespace labeled_cloud;
using semantic_types::ClassId;
using semantic_types::LabeledCloud;

namespace {

constexpr int K = 5;

/** Voxels of two classes; scans take class 1 for 3 in 40 of 100 cases, class 2 for nothing else. */
std::vector<std::vector<double>> countsOf(int scans, int voxels) {
  std::mt19937 random(5);
  ConfusionEstimate estimate(0.5, K);
  for (int s = 0; s < scans; ++s) {
    LabeledCloud cloud;
    for (int v = 0; v < voxels; ++v) {
      const bool errs = v % 2 == 0 && std::uniform_real_distribution<>(0, 1)(random) < 0.4;
      for (const float dx : {0.1f, 0.2f, 0.3f}) {
        cloud.points.emplace_back(0.5f * static_cast<float>(v - voxels / 2) + dx, 0.1f, 0.1f);
        cloud.classes.push_back(static_cast<ClassId>(v % 2 == 1 ? 2 : errs ? 3 : 1));
      }
    }
    estimate.add(cloud, Eigen::Isometry3d::Identity(), 0, 1e9);
  }
  return estimate.counts(0.9);
}

double share(const std::vector<double>& row, int column) {
  double all = 0;
  for (const double n : row) all += n;
  return row[column - 1] / all;
}

}  // namespace

TEST(ConfusionEstimate, findsWhatIsTakenForWhat) {
  const auto counts = countsOf(7, 4000);
  EXPECT_NEAR(share(counts[0], 3), 0.4, 0.06);
  EXPECT_NEAR(share(counts[0], 1), 0.6, 0.06);
  EXPECT_GT(share(counts[1], 2), 0.97);
  EXPECT_NEAR(share(counts[4], 5), 0.9, 0.02);  // never seen
}

TEST(ConfusionEstimate, isWhatWasThereBeforeWithoutVoxelsThatSeveralScansSaw) {
  for (const auto& counts : {countsOf(1, 4000), countsOf(0, 0)})
    for (int k = 1; k <= K; ++k)
      for (int l = 1; l <= K; ++l) EXPECT_NEAR(share(counts[k - 1], l), k == l ? 0.9 : 0.025, 1e-9);
}

TEST(ConfusionEstimate, leavesOutWhatIsTooFarOrHasNoLabel) {
  ConfusionEstimate estimate(0.5, K);
  LabeledCloud cloud;
  cloud.points = {{1, 0, 0}, {9, 0, 0}, {3, 0, 0}};
  cloud.classes = {1, 1, 0};
  for (int s = 0; s < 1000; ++s) estimate.add(cloud, Eigen::Isometry3d::Identity(), 2, 5);
  EXPECT_NEAR(share(estimate.counts(0.9)[0], 1), 0.9, 1e-9);
}
