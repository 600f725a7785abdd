// A trajectory in the frame of a map that is there already.
#include <gtest/gtest.h>
#include <semantic_slam/Reference.h>
#include <semantic_slam/Slam.h>

#include "Recordings.h"

using namespace recordings;
using semantic_octree::SemanticOcTree;

namespace {

/** What somebody else saw of a scene, other scans from between those of recordingOf(). */
SemanticOcTree mapOf(const std::string& scene, std::uint64_t seed, double meters) {
  const synthetic_world::Scene place = synthetic_world::makeScene(scene, seed);
  const synthetic_world::Drive drive(place, 1);
  const Sensor lidar = lidarOf(0.1);
  SemanticOcTree map(0.2, synthetic_world::classTable());
  semantic_octree::InsertionOptions options;
  options.maxRange = 30;
  for (double s = 0.5; s < meters; s += 3) {
    const Eigen::Isometry3d T = drive.T_world_robot(s);
    const auto frame = static_cast<std::uint64_t>(1000 + s);
    map.insert(lidar(place.world, T, {seed, frame}), T * kRobotLidar, options);
  }
  return map;
}

/** Odometry that begins elsewhere. */
void moveOdometry(Recording& r, const Eigen::Isometry3d& T_map_odometry) {
  for (Eigen::Isometry3d& T : r.odometry) T = T_map_odometry * T;
}

struct FrameErrors {
  double first, last, largest, degrees;
};

FrameErrors errorsOf(const Slam& slam, const Recording& r) {
  FrameErrors e{};
  for (std::size_t k = 0; k < slam.poses().size(); ++k) {
    const Vector6 off = vectorOf(r.truth[k].inverse() * slam.poses()[k]);
    e.last = off.head<3>().norm();
    if (k == 0) e.first = e.last;
    e.largest = std::max(e.largest, e.last);
    e.degrees = std::max(e.degrees, off.tail<3>().norm() * 180 / M_PI);
  }
  return e;
}

void addAll(Slam& slam, const Recording& r, const Eigen::Isometry3d& T_robot_sensor) {
  for (std::size_t i = 0; i < r.clouds.size(); ++i)
    slam.add(r.clouds[i], T_robot_sensor, r.odometry[i]);
  ASSERT_EQ(slam.poses().size(), r.truth.size()) << "each scan is a keyframe";
}

}  // namespace

TEST(Reference, aDriveIsInTheFrameOfAMapThatIsThere) {
  Recording r = recordingOf("village", 1, lidarOf(0.1), 90);
  Vector6 off;
  off << 1, -0.8, 0.2, 0, 0, 0.08;
  moveOdometry(r, r.truth[0] * poseOf(off) * r.truth[0].inverse());
  const SemanticOcTree map = mapOf("village", 1, 100);
  for (const bool useClasses : {false, true}) {
    SlamOptions options;
    options.useClasses = useClasses;
    Slam alone(options), slam(options);
    addAll(alone, r, kRobotLidar);
    slam.setReference(map);
    addAll(slam, r, kRobotLidar);
    const FrameErrors without = errorsOf(alone, r), with = errorsOf(slam, r);
    EXPECT_GT(without.last, 1) << useClasses;
    EXPECT_LT(with.first, 0.06) << useClasses;
    EXPECT_LT(with.largest, 0.06) << useClasses;
    EXPECT_LT(with.degrees, 0.2) << useClasses;
    EXPECT_EQ(slam.numLoops(), 0u);
    EXPECT_GT(slam.numReferenced(), 25u) << useClasses;
  }
}

TEST(Reference, aCameraFindsItselfInTheMapOfALidar) {
  Recording r = recordingOf("campus", 1, cameraOf(20), 70);
  Slam slam({});
  slam.setReference(mapOf("campus", 1, 80));
  addAll(slam, r, kRobotCamera);
  const FrameErrors with = errorsOf(slam, r);
  EXPECT_LT(with.largest, 0.12);
  EXPECT_GT(slam.numReferenced(), 20u);
}

TEST(Reference, beyondItsEndScansAreRegisteredToEachOther) {
  const Recording r = recordingOf("village", 1, lidarOf(0.1), 90);
  Slam slam({});
  slam.setReference(mapOf("village", 1, 40));
  addAll(slam, r, kRobotLidar);
  EXPECT_LT(slam.numReferenced(), 25u);
  EXPECT_EQ(slam.numLost(), 0u);
  EXPECT_LT(errorsOf(slam, r).largest, 0.15);
}

TEST(Reference, theMapOfAnotherPlaceMovesNothing) {
  const Recording r = recordingOf("village", 1, lidarOf(0.1), 30);
  Slam alone({}), slam({});
  addAll(alone, r, kRobotLidar);
  slam.setReference(mapOf("campus", 1, 60));
  addAll(slam, r, kRobotLidar);
  EXPECT_EQ(slam.numReferenced(), 0u);
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
