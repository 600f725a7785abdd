#include "planner/PathSmoothing.h"

#include "PathFixture.h"

using namespace semantic_planning;

namespace {

class PathSmoothing : public PathTest {
 protected:
  PathSmoothing() { world.floor(-15, 15, -15, 15, PaintedWorld::Road); }

  /** Smoothed; the arguments are those of the path. */
  std::vector<PathPoint> smooth(const std::vector<PathPoint>& path) {
    std::vector<PathPoint> after;
    for (const Leg& leg : smoothed(path, checker(), ClassPrices(checker().order())))
      appendCurve(checker().trace(leg.curve, leg.from), after);
    return after;
  }
};

const std::vector<ReedsSheppCurve::Segment> kWinding = {{3, 0}, {0.5, 1}, {2, 0}, {0.7, -1},
                                                        {2, 0}, {0.4, 1}, {3, 0}, {0.6, -1},
                                                        {2, 0}, {0.4, 1}, {3, 0}};

}  // namespace

TEST_F(PathSmoothing, aWindingWayIsStraightenedAndEndsWhereItDid) {
  start = {-10, 0, 0};
  const auto before = drive(start, kWinding), after = smooth(before);
  PathChecker(world.map(), options.vehicle).expectDrivable(after);
  expectSameEnds(after, before);
  EXPECT_LT(after.back().arcLength, before.back().arcLength);
  EXPECT_EQ(steeringChanges(before), 10);
  EXPECT_LE(steeringChanges(after), 4);
}

TEST_F(PathSmoothing, keepsOffWalls) {
  start = {-10, 0, 0};
  const auto before = drive(start, kWinding);
  for (std::size_t i = 60; i + 60 < before.size(); i += 40)  // beside it, on both sides
    for (const int side : {-1, 1}) {
      const double x = before[i].x - side * 1.2 * std::sin(before[i].heading);
      const double y = before[i].y + side * 1.2 * std::cos(before[i].heading);
      world.box(x - 0.1, x + 0.1, y - 0.1, y + 0.1, 0, 2, PaintedWorld::Wall);
    }
  readGroundAgain();
  const auto after = smooth(before);
  PathChecker(world.map(), options.vehicle).expectDrivable(after);
  expectSameEnds(after, before);
  EXPECT_LT(steeringChanges(after), steeringChanges(before));
}

TEST_F(PathSmoothing, neverCostsMoreWhateverTheRate) {
  start = {-10, 0, 0};
  world.floor(-6, 6, -3, 0.2, PaintedWorld::Grass);
  for (const double rate : {0., 1., 10., 100.}) {
    readGroundAgain();
    order = order.withRates({rate, 200, 300});
    const auto before = drive(start, kWinding);
    const ClassPrices prices(checker().order());
    const auto price = [&](const std::vector<PathPoint>& path) {
      PlanResult plan;
      plan.path = path;
      setLengths(plan, checker(), prices);
      return plan.price;
    };
    EXPECT_LT(price(smooth(before)), price(before));
  }
}

TEST_F(PathSmoothing, gearsAndWaysBackwardsStayAsTheyAre) {
  start = {-10, 0, 0};
  const auto before = drive(start, {{4, 0},
                                    {0.5, 1},
                                    {2, 0},
                                    {0.5, -1},
                                    {2, 0},
                                    {-1, 1},
                                    {-1, 0},
                                    {-1, -1},
                                    {2, 0},
                                    {0.5, 1},
                                    {1, 0},
                                    {0.5, -1},
                                    {3, 0}});
  const auto after = smooth(before);
  PathChecker(world.map(), options.vehicle).expectDrivable(after);
  expectSameEnds(after, before);
  const auto backwards = [](const std::vector<PathPoint>& path) {
    std::vector<double> curvatures;
    for (const PathPoint& p : path)
      if (!p.forward) curvatures.push_back(p.curvature);
    return curvatures;
  };
  EXPECT_EQ(backwards(after), backwards(before));
  EXPECT_LT(steeringChanges(after), steeringChanges(before));
}
