#include <gtest/gtest.h>
#include <semantic_driving/DrivePath.h>
#include <semantic_driving/PathCheck.h>
#include <semantic_driving/PathTracker.h>

#include <cmath>

#include "PaintedPlanner.h"

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

constexpr double kVoxel = 0.2, kToTheFront = 0.55, kClearance = 0.1;  // m

/** Along x, `length` meters. */
DrivePath alongX(double length) {
  std::vector<PathPoint> points;
  for (double x = 0.1; x <= length + 0.1 + 1e-9; x += 0.1)
    points.push_back({x, 0.1, 0, 0, 0, true, 0, 0});
  return DrivePath(points);
}

/** A road up to x = 5, and grass, on rank 1, from there on. */
class OfAPath : public testing::Test {
 protected:
  OfAPath() {
    world.floor(-4, 5, -4, 4, PaintedWorld::Road);
    world.floor(5, 20, -4, 4, PaintedWorld::Grass);
  }
  PathJudgment judge(const DrivePath& path, double from = 0) {
    const SemanticPlanner planner = plannerOver(world);
    return PathCheck(planner).judge(path, from);
  }
  PaintedWorld world;
};

constexpr double kRate = 4;  // of the second rank

PathJudgment judged(double best, double second) {
  PathJudgment judgment;
  judgment.price = best + second + kRate * second;
  return judgment;
}

TEST_F(OfAPath, TellsThePriceOfItsClasses) {
  const PathJudgment judgment = judge(alongX(12));
  EXPECT_TRUE(judgment.isFree());
  EXPECT_NEAR(judgment.price, 12 + kRate * (12 - 5 + 0.1), kRate * 2 * kVoxel);
  EXPECT_NEAR(judge(alongX(12), 6).price, 6 + kRate * 6, 1e-6);
}

TEST_F(OfAPath, WithAStrictOrderClassesOutweighAnyLength) {
  SemanticPlanner planner = plannerOver(world);
  const SemanticPlanner strict(world.map(), planner.order().strict(), planner.options());
  EXPECT_NEAR(PathCheck(strict).judge(alongX(12), 0).price, 12 + 1000 * (12 - 5 + 0.1),
              1000 * 2 * kVoxel);
}

TEST_F(OfAPath, TellsHowFarItIsFree) {
  const DrivePath path = alongX(12);
  ASSERT_TRUE(judge(path).isFree());
  world.box(8, 8.2, -1, 1, 0, 1, PaintedWorld::Wall);
  EXPECT_NEAR(judge(path).freeFor, 8 - 0.1 - kToTheFront - kClearance, 2 * kVoxel);
  EXPECT_NEAR(judge(path, 3).freeFor, judge(path).freeFor - 3, kVoxel + 1e-6);
  EXPECT_TRUE(judge(path, 10).isFree());  // it is behind
}

TEST_F(OfAPath, ForbiddenGroundIsInTheWay) {
  world.floor(6, 7, -4, 4, PaintedWorld::Mud);
  EXPECT_NEAR(judge(alongX(12)).freeFor, 6 - 0.1, kVoxel);  // the wheels come there
}

TEST_F(OfAPath, TellsThePriceOfDrivingTheRest) {
  EXPECT_NEAR(judge(alongX(4)).price, 4, 1e-6);
  std::vector<PathPoint> points = alongX(4).points();
  for (int i = 1; i <= 10; ++i) points.push_back({4.1 - 0.1 * i, 0.1, 0, 0, 0, true, 0, 0});
  const VehicleOptions vehicle;  // the planner's
  const double back = vehicle.gearChange + vehicle.reverseWeight;
  const double piece = 0.1 * (vehicle.reverseWeight - 1);  // before the change counts as backwards
  EXPECT_NEAR(judge(DrivePath(points), 1).price, 3 + back, piece + 1e-6);
  EXPECT_NEAR(judge(DrivePath(points), 4.5).price, 0.5 * vehicle.reverseWeight, 1e-6);
}

TEST(PathJudgment, AFewMetersOfAWorseClassDoNotOutweighALongStretchBackwards) {
  PathJudgment far = judged(12, 0), ahead = judged(9, 3);
  far.longestBackwards = 9;
  EXPECT_TRUE(ahead.isClearlyBetterThan(far));
  EXPECT_FALSE(far.isClearlyBetterThan(ahead));
  ahead.longestBackwards = 5;  // both
  EXPECT_TRUE(far.isClearlyBetterThan(ahead));
}

TEST_F(OfAPath, TellsTheLongestStretchBackwardsOfTheRest) {
  std::vector<PathPoint> points = alongX(4).points();
  for (int i = 1; i <= 20; ++i) points.push_back({4.1 - 0.1 * i, 0.1, 0, 0, 0, true, 0, 0});
  for (int i = 1; i <= 10; ++i) points.push_back({2.1 + 0.1 * i, 0.1, 0, 0, 0, true, 0, 0});
  for (int i = 1; i <= 3; ++i) points.push_back({3.1 - 0.1 * i, 0.1, 0, 0, 0, true, 0, 0});
  EXPECT_NEAR(judge(DrivePath(points)).longestBackwards, 2, 1e-6);
  EXPECT_NEAR(judge(DrivePath(points), 5).longestBackwards, 1, 1e-6);
  EXPECT_NEAR(judge(DrivePath(points), 6.5).longestBackwards, 0.3, 1e-6);
  EXPECT_EQ(judge(alongX(4)).longestBackwards, 0);
}

TEST(PathJudgment, IsBetterIfItsPriceIsLowerByATenthAndHalfAMeter) {
  const struct {
    PathJudgment path, other;
    bool better;
  } rows[] = {{judged(20, 0), judged(10, 3), true},  // longer, but all on the best class
              {judged(10, 3), judged(20, 0), false},
              {judged(9, 0), judged(11, 0), true},    // shorter by more than a tenth
              {judged(9, 0), judged(9.9, 0), false},  // by less
              {judged(2, 0), judged(2.4, 0), false},  // by less than half a meter
              {judged(2, 0), judged(2.6, 0), true},
              {judged(9, 1), judged(9, 1.2), false},
              {judged(2, 1.4), judged(9, 1), true}};
  for (const auto& row : rows)
    EXPECT_EQ(row.path.isClearlyBetterThan(row.other), row.better)
        << row.path.price << ", " << row.other.price;
}

TEST(DrivenTrack, LeadsBackTheWayTheVehicleCame) {
  constexpr double kRadius = 2;
  DrivenTrack track;
  for (double a = 0; a < 1; a += 0.01)  // ahead on an arc to the left
    track.add({kRadius * std::sin(a), kRadius * (1 - std::cos(a)), a});
  const DrivePath back(track.back());
  EXPECT_NEAR(back.length(), kRadius, 0.2);
  EXPECT_NEAR(back.stretchEnd(0.1), back.length(), 1e-9);
  for (double s = 0; s < back.length() - 0.2; s += 0.1) EXPECT_FALSE(back.at(s).forward);
  EXPECT_NEAR(std::hypot(back.at(2).x, back.at(2).y), 0, 0.1);
}

TEST(DrivenTrack, ForgetsWhatTheVehicleWentBackOnAndWhatIsLongAgo) {
  DrivenTrack track(3);
  for (double x = 0; x <= 5; x += 0.05) track.add({x, 0, 0});
  const double kept = DrivePath(track.back()).length();
  EXPECT_GE(kept, 2.9);
  EXPECT_LE(kept, 4.5);
  for (double x = 5; x >= 4; x -= 0.05) track.add({x, 0, 0});
  const DrivePath back(track.back());
  EXPECT_NEAR(back.points().front().x, 4, 0.15);
  EXPECT_NEAR(back.length(), kept - 1, 0.2);
  EXPECT_NEAR(back.stretchEnd(0), back.length(), 1e-9);
}

constexpr double kLongest = 8;  // m backwards

/** Ahead along x from 0.1 to 3.1 m, and back to -3.9 m. */
DrivePath pathThereAndBack(PaintedWorld::Class ground = PaintedWorld::Grass) {
  std::vector<PathPoint> points;
  for (int i = 0; i <= 30; ++i) points.push_back({0.1 + 0.1 * i, 0.1, -0.1, 0, 0, true, ground, 0});
  for (int i = 1; i <= 70; ++i)
    points.push_back({3.1 - 0.1 * i, 0.1, -0.1, 0, 0, false, ground, 0});
  return DrivePath(points);
}

/** The path is over grass. */
class InPlaceOfBackingUp : public testing::Test {
 protected:
  InPlaceOfBackingUp() { world.floor(-12, 12, -8, 8, PaintedWorld::Grass); }
  std::optional<DrivePath> find(double from = 0, double worth = 0.5,
                                PaintedWorld::Class ground = PaintedWorld::Grass) {
    const SemanticPlanner planner = plannerOver(world);
    const DrivePath path = pathThereAndBack(ground);
    const auto found = ForwardTurns(planner, kLongest).find(path, from, worth);
    if (found) {
      const MotionCost price(planner.options().vehicle);
      EXPECT_LT(price.of(found->points()), price.of(path.points()) - worth);
    }
    return found;
  }
  PaintedWorld world;
};

}  // namespace

TEST_F(InPlaceOfBackingUp, GoesAheadToTheSamePose) {
  const auto found = find();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->stretchEnd(0), found->length());  // no change of gear
  EXPECT_TRUE(found->at(0).forward);
  const PathPoint begin = found->points().front(), end = found->points().back();
  EXPECT_NEAR(std::hypot(begin.x - 0.1, begin.y - 0.1), 0, 1e-6);
  EXPECT_NEAR(std::hypot(end.x + 3.9, end.y - 0.1, std::sin(end.heading)), 0, 1e-6);
  EXPECT_GT(std::cos(end.heading), 0);
}

TEST_F(InPlaceOfBackingUp, LeavesTheBeginningAsItIs) {
  const auto found = find(2);
  ASSERT_TRUE(found);
  for (double s = 0; s <= 2; s += 0.1) EXPECT_NEAR(found->at(s).y, 0.1, 1e-6) << s;
  EXPECT_NEAR(found->at(2).x, 2.1, 1e-6);
}

TEST_F(InPlaceOfBackingUp, ThereIsNothingWhereItCostsMore) { EXPECT_FALSE(find(0, 50)); }

TEST_F(InPlaceOfBackingUp, ThereIsNothingWhereItDoesNotFit) {
  world.box(-12, 12, 1, 1.2, 0, 1, PaintedWorld::Wall);
  world.box(-12, 12, -1, -0.8, 0, 1, PaintedWorld::Wall);
  EXPECT_FALSE(find());
}

TEST_F(InPlaceOfBackingUp, ThereIsNothingOverAWorseClass) {
  world.floor(-12, 12, -1, 1.2, PaintedWorld::Road);
  EXPECT_FALSE(find(0, 0.5, PaintedWorld::Road));
  world.floor(-12, 12, -8, 8, PaintedWorld::Road);
  EXPECT_TRUE(find(0, 0.5, PaintedWorld::Road));
}

TEST_F(InPlaceOfBackingUp, FarThereMayBeWhatThePathMeetsElsewhere) {
  world.floor(-12, 12, -1, 1.2, PaintedWorld::Road);
  std::vector<PathPoint> points = pathThereAndBack(PaintedWorld::Road).points();
  points.front().classId = PaintedWorld::Grass;
  const SemanticPlanner planner = plannerOver(world);
  EXPECT_FALSE(ForwardTurns(planner, 8).find(DrivePath(points), 0.5, 0.5));
  const auto found = ForwardTurns(planner, 6).find(DrivePath(points), 0.5, 0.5);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->longestBackwards(), 0);
  EXPECT_FALSE(ForwardTurns(planner, 6).find(pathThereAndBack(PaintedWorld::Road), 0.5, 0.5));
}

TEST_F(InPlaceOfBackingUp, APathWithoutChangesStays) {
  const SemanticPlanner planner = plannerOver(world);
  EXPECT_FALSE(ForwardTurns(planner, kLongest).find(pathThereAndBack().part(0, 3), 0, 0));
  EXPECT_FALSE(ForwardTurns(planner, kLongest).find({}, 0, 0));
}
