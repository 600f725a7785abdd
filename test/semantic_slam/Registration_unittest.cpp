#include <gtest/gtest.h>
#include <semantic_slam/Registration.h>
#include <semantic_slam/Slam.h>
#include <semantic_types/ClassTable.h>

#include <random>
#include <set>
#include <tuple>

#include "DataSets.h"
#include "Recordings.h"
#include "SensorScale.h"
#include "SharedData.h"

using namespace semantic_slam;

namespace {

/** Meters and degrees of what is left. */
struct Errors {
  double meters = 0, degrees = 0;
  double worstMeters = 0;
};

/** Each scan but the first few is put up to 1 m and 3 degrees beside its pose, and registered to
 * the five before it. */
Errors registeredBack(const std::vector<LabeledFrame>& frames, bool useClasses) {
  std::mt19937 random(4);
  const auto uniform = [&random] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  Errors errors;
  const int first = 3;
  for (int i = first; i < static_cast<int>(frames.size()); ++i) {
    std::vector<Submap> submaps;
    for (const double cellSize : {2.0, 1.0, 0.5}) {
      submaps.emplace_back(cellSize, useClasses);
      for (int j = std::max(0, i - 5); j < i; ++j)
        submaps.back().add(frames[j].cloud,
                           frames[i].T_map_sensor.inverse() * frames[j].T_map_sensor);
      submaps.back().finish();
    }
    Vector6 offset;
    offset << uniform(), uniform(), 0.2 * uniform(), 0.01 * uniform(), 0.01 * uniform(),
        0.05 * uniform();
    const Registration r = registerScan({&submaps[0], &submaps[1], &submaps[2]},
                                        thinned(frames[i].cloud, 0.5, 40), poseOf(offset));
    const Vector6 left = vectorOf(r.T_submap_scan);
    errors.meters += left.head<3>().norm();
    errors.worstMeters = std::max(errors.worstMeters, left.head<3>().norm());
    errors.degrees += left.tail<3>().norm() * 180 / M_PI;
  }
  const double n = static_cast<double>(frames.size()) - first;
  return {errors.meters / n, errors.degrees / n, errors.worstMeters};
}

class RegisteredStreet : public testing::TestWithParam<const char*> {};

}  // namespace

TEST_P(RegisteredStreet, scansComeBackToTheirPoses) {
  const std::string sequence = std::string("semantic_kitti/") + GetParam();
  SKIP_WITHOUT_DATA(sequence);
  const auto table = semantic_types::loadClassTable(std::filesystem::path(MSO_SOURCE_DIR) /
                                                    "config/classes/semantic_kitti.yaml");
  const auto frames = readSemanticKitti(sharedDataDir() / sequence, table);
  for (const bool useClasses : {false, true}) {
    const Errors e = registeredBack(frames, useClasses);
    EXPECT_LT(e.meters, 0.03) << useClasses;
    EXPECT_LT(e.worstMeters, 0.05) << useClasses;
    EXPECT_LT(e.degrees, 0.1) << useClasses;
  }
}

INSTANTIATE_TEST_SUITE_P(Sequences, RegisteredStreet, testing::Values("00", "07"));

TEST(Registration, ofASurfaceThatOnlyClassesMakeUnique) {
  // A plane with stripes: along them nothing tells where the scan was, across them classes do.
  std::mt19937 random(1);
  const auto plane = [&random] {
    LabeledCloud cloud;
    for (int i = 0; i < 20000; ++i) {
      const float x = static_cast<float>(random() % 20000) / 1000 - 10,
                  y = static_cast<float>(random() % 20000) / 1000 - 10;
      cloud.points.emplace_back(x, y, 0.f);
      cloud.classes.push_back(static_cast<semantic_types::ClassId>(
          1 + static_cast<int>(std::floor((x + 100) / 2.3f)) % 2));
    }
    return cloud;
  };
  const LabeledCloud map = plane(), scan = plane();
  for (const bool useClasses : {false, true}) {
    Submap submap(0.5, useClasses);
    submap.add(map, Eigen::Isometry3d::Identity());
    submap.finish();
    Vector6 offset = Vector6::Zero();
    offset[0] = 0.4;
    offset[2] = 0.2;
    const Vector6 left =
        vectorOf(registerScan({&submap}, thinned(scan, 0.2, 100), poseOf(offset)).T_submap_scan);
    EXPECT_LT(std::abs(left[2]), 0.01);
    EXPECT_EQ(std::abs(left[0]) < 0.1, useClasses) << left.transpose();
  }
}

TEST(Registration, aSurfaceThatGoesOnSaysNothingAlongItself) {
  // Ground up to 5 m ahead, and what is seen of it a meter farther on: only its height is known.
  const auto groundUpTo = [](double end) {
    LabeledCloud cloud;
    for (int x = -200; x < 20 * end; ++x)
      for (int y = -200; y < 200; ++y)
        cloud.points.emplace_back(0.05f * x + 0.025f, 0.05f * y + 0.025f, 0.f);
    return cloud;
  };
  Submap submap(1, false);
  submap.add(groundUpTo(5), Eigen::Isometry3d::Identity());
  submap.finish();
  Vector6 offset = Vector6::Zero();
  offset[2] = 0.1;
  const Registration r = registerScan({&submap}, thinned(groundUpTo(6), 0.5, 100), poseOf(offset),
                                      informationOf(0.02, 0.002));
  const Vector6 left = vectorOf(r.T_submap_scan);
  EXPECT_LT(std::abs(left[2]), 0.005);
  EXPECT_LT(left.head<2>().norm(), 0.005);
  EXPECT_LT(std::abs(left[5]), 1e-3);
  EXPECT_LT(r.information(0, 0), 1e-3 * r.information(2, 2));
  EXPECT_LT(r.information(1, 1), 1e-3 * r.information(2, 2));
}

TEST(Registration, thinnedPointsAreAnyOfTheirCubes) {
  // Rows that look down on the ground from 1.4 m, far ones first, with noise along the rays.
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 0.02f);
  LabeledCloud ground;
  for (int row = 0; row < 400; ++row)
    for (int column = 0; column < 400; ++column) {
      const Eigen::Vector3f seen(6 - 0.01f * static_cast<float>(row),
                                 0.025f * static_cast<float>(column - 200), -1.4f);
      ground.points.push_back(seen + noise(random) * seen.normalized());
    }
  const LabeledCloud thin = thinned(ground, 0.25, 100), again = thinned(ground, 0.25, 100);
  std::set<std::tuple<int, int, int>> cubes, drawn;
  const auto cubeOf = [](const Eigen::Vector3f& p) {
    return std::tuple(static_cast<int>(std::floor(p.x() * 4)),
                      static_cast<int>(std::floor(p.y() * 4)),
                      static_cast<int>(std::floor(p.z() * 4)));
  };
  for (const Eigen::Vector3f& p : ground.points) cubes.insert(cubeOf(p));
  double height = 0;
  for (const Eigen::Vector3f& p : thin.points) {
    EXPECT_TRUE(drawn.insert(cubeOf(p)).second);
    height += (p.z() + 1.4) / static_cast<double>(thin.size());
  }
  EXPECT_EQ(drawn, cubes);
  EXPECT_NEAR(height, 0, 0.001);
  EXPECT_EQ(thin.points, again.points);
}

// A trajectory in the frame of a map that is there already.

using namespace recordings;
using semantic_octree::SemanticOcTree;

namespace {

/** A map with classes, of which a tenth are wrong. */
SemanticOcTree mapOf(const std::string& scene, std::uint64_t seed, double meters) {
  return recordings::mapOf(scene, seed, {lidarOf(0.1), kRobotLidar, meters});
}

}  // namespace

TEST(Reference, aDriveIsInTheFrameOfAMapThatIsThere) {
  Recording r = recordingOf("village", 1, lidarOf(0.1), 90);
  Vector6 off;
  off << 1, -0.8, 0.2, 0, 0, 0.08;
  moveOdometry(r, off);
  const SemanticOcTree map = mapOf("village", 1, 100);
  for (const bool useClasses : {false, true}) {
    SlamOptions options;
    options.useClasses = useClasses;
    Slam alone(options), slam(options);
    addAll(alone, r, kRobotLidar);
    slam.setReference(map);
    addAll(slam, r, kRobotLidar);
    const PathErrors without = errorsOf(alone.poses(), r), with = errorsOf(slam.poses(), r);
    EXPECT_GT(without.last, 1) << useClasses;
    EXPECT_LT(with.first, 0.06) << useClasses;
    EXPECT_LT(with.largest, 0.06) << useClasses;
    EXPECT_LT(with.degrees, 0.2) << useClasses;
    EXPECT_EQ(slam.report().loops, 0u);
    EXPECT_GT(slam.report().referenced, 25u) << useClasses;
  }
}

TEST(Reference, aCameraFindsItselfInTheMapOfALidar) {
  Recording r = recordingOf("campus", 1, cameraOf(20), 70);
  Slam slam({});
  slam.setReference(mapOf("campus", 1, 80));
  addAll(slam, r, kRobotCamera);
  const PathErrors with = errorsOf(slam.poses(), r);
  EXPECT_LT(with.largest, 0.12);
  EXPECT_GT(slam.report().referenced, 20u);
}

TEST(Reference, beyondItsEndScansAreRegisteredToEachOther) {
  const Recording r = recordingOf("village", 1, lidarOf(0.1), 90);
  Slam slam({});
  slam.setReference(mapOf("village", 1, 40));
  addAll(slam, r, kRobotLidar);
  EXPECT_LT(slam.report().referenced, 25u);
  EXPECT_EQ(slam.report().lost, 0u);
  EXPECT_LT(errorsOf(slam.poses(), r).largest, 0.15);
}

TEST(Reference, theMapOfAnotherPlaceMovesNothing) {
  const Recording r = recordingOf("village", 1, lidarOf(0.1), 30);
  Slam alone({}), slam({});
  addAll(alone, r, kRobotLidar);
  slam.setReference(mapOf("campus", 1, 60));
  addAll(slam, r, kRobotLidar);
  EXPECT_EQ(slam.report().referenced, 0u);
  for (std::size_t k = 0; k < r.truth.size(); ++k)
    EXPECT_TRUE(slam.poses()[k].isApprox(alone.poses()[k], 0)) << k;
}

TEST(Reference, comesBeforeTheFirstScan) {
  const Recording r = recordingOf("village", 1, lidarOf(0), 1);
  Slam slam({});
  slam.add(r.clouds[0], kRobotLidar, r.odometry[0]);
  EXPECT_THROW(slam.setReference(SemanticOcTree(0.2, synthetic_world::classTable())),
               std::logic_error);
}

namespace {

/** Returns from all sides, half of them nearer than a distance, m. */
LabeledCloud cloudOf(double median) {
  std::mt19937 random(1);
  const auto uniform = [&random] { return static_cast<float>(random()) / 2147483648.f - 1; };
  LabeledCloud cloud;
  for (int i = 1; i < 1000; ++i) {
    const Eigen::Vector3f direction = Eigen::Vector3f(uniform(), uniform(), uniform()).normalized();
    cloud.points.push_back(direction * static_cast<float>(median * i / 500));
  }
  return cloud;
}

}  // namespace

TEST(SensorScale, aSceneOfHalfTheSizeHasHalfTheLengths) {
  for (const double factor : {0.8, 1., 1.3})
    for (const double smaller : {0.5, 0.25}) {
      const SensorScale street = SensorScale::of(cloudOf(8 * factor), false),
                        s = SensorScale::of(cloudOf(8 * factor * smaller), false);
      EXPECT_DOUBLE_EQ(s.keyframeDistance, smaller * street.keyframeDistance);
      EXPECT_DOUBLE_EQ(s.cube, smaller * street.cube);
      EXPECT_DOUBLE_EQ(s.gridCell, smaller * street.gridCell);
      EXPECT_DOUBLE_EQ(s.loopLength, smaller * street.loopLength);
      ASSERT_EQ(s.cells.size(), street.cells.size());
      for (std::size_t i = 0; i < s.cells.size(); ++i)
        EXPECT_DOUBLE_EQ(s.cells[i], smaller * street.cells[i]);
      EXPECT_EQ(s.keyframeAngle, street.keyframeAngle);
      EXPECT_EQ(s.submapKeyframes, street.submapKeyframes);
    }
}

TEST(SensorScale, isOfStreetsAtMostAndOfRoomsAtLeast) {
  EXPECT_EQ(SensorScale::of(cloudOf(40), false).cube, SensorScale::of(cloudOf(8), false).cube);
  EXPECT_EQ(SensorScale::of(cloudOf(0.3), false).cube, SensorScale::of(cloudOf(2), false).cube);
  EXPECT_EQ(SensorScale::of({}, false).cube, SensorScale::of(cloudOf(2), false).cube);
}

TEST(SensorScale, isOfTheSurroundingsNotOfTheGroundBeforeACamera) {
  LabeledCloud cloud = cloudOf(8);
  for (int i = 0; i < 3000; ++i) cloud.points.emplace_back(1 + 1e-3f * i, 0, -1);
  EXPECT_EQ(SensorScale::of(cloud, false).cube, SensorScale::of(cloudOf(8), false).cube);
}
