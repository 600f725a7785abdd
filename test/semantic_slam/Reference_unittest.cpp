// A trajectory in the frame of a map that is there already.
#include <gtest/gtest.h>
#include <semantic_slam/Reference.h>
#include <semantic_slam/Slam.h>

#include "Recordings.h"

using namespace recordings;
using semantic_octree::SemanticOcTree;

namespace {

/** Of classes, a tenth of them wrong. */
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
