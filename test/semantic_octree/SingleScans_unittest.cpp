// What single scans do that can be told by hand.
#include <gtest/gtest.h>

#include <algorithm>

#include "PlainMap.h"
#include "RandomScans.h"

using namespace semantic_octree;

namespace {

constexpr double kScanResolution = 0.2;

}  // namespace

TEST(SingleScans, countsAVoxelOnceForEachScanForever) {
  // A voxel seen again exactly n scans later for every n up to ten, and 300 scans in a row.
  SemanticOcTree tree(kScanResolution, numberedClasses(2));
  PlainMap plain(kScanResolution, 2);
  PosedCloud here, elsewhere;
  here.cloud.points = {{1.1f, 0.1f, 0.1f}, {1.12f, 0.1f, 0.1f}, {3.1f, 0.1f, 0.1f}};
  elsewhere.cloud.points = {{-1.1f, 0.1f, 0.1f}};
  const auto insert = [&](const PosedCloud& scan) {
    tree.insert(scan.cloud, scan.T_map_sensor);
    plain.insert(scan, {});
    expectSame(tree, plain);
  };
  for (int pause = 0; pause < 10; ++pause) {
    insert(here);
    for (int i = 0; i < pause; ++i) insert(elsewhere);
  }
  for (int i = 0; i < 300; ++i) insert(i % 3 ? elsewhere : here);
}

TEST(SingleScans, ofBeamsAlongVoxelBordersStaysInTheBeamsNeighborhood) {
  std::mt19937 random(8);
  for (int i = 0; i < 300; ++i) {
    SemanticOcTree tree(1.0, numberedClasses(1));
    LabeledCloud cloud;
    const auto whole = [&] { return static_cast<float>(static_cast<int>(random() % 13) - 6); };
    cloud.points = {{whole(), whole(), whole()}};
    Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
    T_map_sensor.translation() << whole(), whole(), whole();
    tree.insert(cloud, T_map_sensor);
    const Eigen::Vector3d begin = T_map_sensor.translation(), beam = cloud.points[0].cast<double>();
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
      const Eigen::Vector3d center(leaf.getX(), leaf.getY(), leaf.getZ());
      const double t = beam.squaredNorm() > 0
                           ? std::clamp((center - begin).dot(beam) / beam.squaredNorm(), 0.0, 1.0)
                           : 0.0;
      ASSERT_LE((center - begin - t * beam).norm(), std::sqrt(3.0) / 2 + 1e-9);
    }
    const Eigen::Vector3d end = begin + beam;
    ASSERT_EQ(tree.query(end.x(), end.y(), end.z()).status, CellState::Status::Occupied);
  }
}

TEST(SingleScans, reportsWhatBecameOfEachPoint) {
  SemanticOcTree tree(0.1, numberedClasses(2));
  LabeledCloud cloud;
  cloud.points = {{NAN, 0, 0}, {0, INFINITY, 0}, {0.1f, 0, 0},
                  {1, 0, 0},   {50, 0, 0},       {1e30f, 0, 0}};
  InsertionOptions options;
  options.maxRange = 10;
  options.minRange = 0.5;
  const InsertionReport report = tree.insert(cloud, Eigen::Isometry3d::Identity(), options);
  EXPECT_EQ(report.points, 6u);
  EXPECT_EQ(report.skippedNotFinite, 2u);
  EXPECT_EQ(report.skippedNear, 1u);
  EXPECT_EQ(report.beyondRange, 2u);
  EXPECT_EQ(report.hitVoxels, 1u);
  EXPECT_EQ(report.freeVoxels, 99u);
}

TEST(SingleScans, skipsReturnsOutsideTheMap) {
  SemanticOcTree tree(0.001, numberedClasses(2));  // reaches 32.768 m
  LabeledCloud cloud;
  cloud.points = {{40, 0, 0}, {0, -40, 0}, {32.7f, 0, 0}};
  EXPECT_EQ(tree.insert(cloud, Eigen::Isometry3d::Identity()).skippedOutside, 2u);
  EXPECT_EQ(tree.query(32.7, 0, 0).status, CellState::Status::Occupied);
}

TEST(SingleScans, worksInTheOutermostVoxels) {
  for (const double corner : {-double{kKeyOfOrigin}, kKeyOfOrigin - 0.5}) {
    SemanticOcTree tree(1.0, numberedClasses(2));
    Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
    T_map_sensor.translation().setConstant(corner);
    LabeledCloud cloud;
    const float inwards = corner < 0 ? 5.f : -5.f;
    cloud.points = {{inwards, 0, 0}, {0, inwards, 0}, {0, 0, inwards}, {-inwards, 0, 0}};
    const InsertionReport report = tree.insert(cloud, T_map_sensor);
    EXPECT_EQ(report.hitVoxels, 3u);
    EXPECT_EQ(report.skippedOutside, 1u);
    EXPECT_EQ(tree.query(corner, corner, corner).status, CellState::Status::Free);
    EXPECT_EQ(tree.query(corner + inwards, corner, corner).status, CellState::Status::Occupied);
  }
}

TEST(SingleScans, ofAnEmptyCloudChangesNothing) {
  SemanticOcTree tree(0.1, numberedClasses(2));
  EXPECT_EQ(tree.insert({}, Eigen::Isometry3d::Identity()).points, 0u);
  EXPECT_TRUE(tree.empty());
  LabeledCloud onlyNan;
  onlyNan.points = {{NAN, NAN, NAN}};
  tree.insert(onlyNan, Eigen::Isometry3d::Identity());
  EXPECT_TRUE(tree.empty());
}
