#include <gtest/gtest.h>
#include <semantic_driving/PathTracker.h>

#include <cmath>

using namespace semantic_driving;
using namespace semantic_planning;

namespace {

/** Ahead for 2 m along x, then back for 1 m. */
std::vector<PathPoint> thereAndBack() {
  std::vector<PathPoint> points;
  for (int i = 0; i <= 20; ++i) points.push_back({0.1 * i, 0, 0, 0, 0, true, 0, 0});
  for (int i = 1; i <= 10; ++i) points.push_back({2 - 0.1 * i, 0, 0, 0, 0, false, 0, 0});
  return points;
}

PathTracker trackerOn(const std::vector<PathPoint>& points) {
  PathTracker tracker({}, Footprint::rectangle(-0.25, 0.55, 0.6));
  tracker.setPath(DrivePath(points));
  return tracker;
}

}  // namespace

TEST(DrivePath, HasStretchesOfOneGear) {
  const DrivePath path(thereAndBack());
  EXPECT_NEAR(path.length(), 3, 1e-9);
  EXPECT_NEAR(path.stretchEnd(0.5), 2, 1e-9);
  EXPECT_NEAR(path.stretchEnd(2.5), 3, 1e-9);
  EXPECT_NEAR(path.stretchBegin(2.5), 2, 1e-9);
  EXPECT_TRUE(path.at(1).forward);
  EXPECT_FALSE(path.at(2.5).forward);
  EXPECT_NEAR(path.at(2.5).x, 1.5, 1e-9);
}

TEST(DrivePath, GivesWaypointsUpToTheEndOfTheStretch) {
  const auto waypoints = DrivePath(thereAndBack()).waypoints(0.5, 0.6);
  ASSERT_EQ(waypoints.size(), 3u);
  EXPECT_NEAR(waypoints[0].x, 1, 1e-9);
  EXPECT_NEAR(waypoints[2].x, 2, 1e-9);
}

TEST(DrivePath, IsCutAndJoined) {
  const DrivePath path(thereAndBack());
  const DrivePath joined = path.part(1, 2, path.part(2, 2.5));
  EXPECT_NEAR(joined.length(), 1.5, 1e-9);
  EXPECT_NEAR(joined.stretchEnd(0), 1, 1e-9);
}

TEST(PathTracker, SteersBackToThePathAndSlowsDownAtItsEnd) {
  PathTracker tracker = trackerOn(thereAndBack());
  tracker.locate({{0.5, 0.2, 0}, 0, 0});
  EXPECT_LT(tracker.command({{0.5, 0.2, 0}, 0, 0}, {}, 1).turn, 0);
  tracker.locate({{1.9, 0, 0}, 0, 0});
  EXPECT_LT(tracker.command({{1.9, 0, 0}, 0, 0}, {}, 1).speed, 0.5);
}

TEST(PathTracker, BacksUpWhereThePathDoes) {
  PathTracker tracker = trackerOn(thereAndBack());
  for (double x = 0; x <= 2; x += 0.1) tracker.locate({{x, 0, 0}, 0, 0});
  tracker.locate({{2, 0, 0}, 0, 0});
  EXPECT_LT(tracker.command({{2, 0, 0}, 0, 0}, {}, 1).speed, 0);
}

TEST(PathTracker, StopsBeforeAnObstacle) {
  PathTracker tracker = trackerOn(thereAndBack());
  const semantic_driving::DriveState state{{0, 0, 0}, 0, 0};
  tracker.locate(state);
  EXPECT_GT(tracker.command(state, {}, 1).speed, 0.9);
  EXPECT_NEAR(tracker.freeAhead(state, {{1.5, 0}}), 1.5 - 0.55 - 0.1, 0.16);
  EXPECT_EQ(tracker.command(state, {{0.75, 0}}, 1).speed, 0);
}

TEST(PathTracker, TooNearToAnObstacleOnlyTheWayOutIsNoApproach) {
  const PathTracker tracker = trackerOn(thereAndBack());
  const ObstaclePoints ahead = {{0.58, 0.1}}, inside = {{0.5, 0}}, farOff = {{0.7, 0}};
  for (const ObstaclePoints& near : {ahead, inside}) {
    EXPECT_TRUE(tracker.approaches({0.5, 0}, near, 0.05));
    EXPECT_FALSE(tracker.approaches({-0.5, 0}, near, 0.05));
  }
  EXPECT_FALSE(tracker.approaches({0.5, 0}, farOff, 0.05));
}
