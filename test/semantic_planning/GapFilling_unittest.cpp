#include <gtest/gtest.h>
#include <semantic_planning/ground/Ground.h>

#include "PaintedWorld.h"

using namespace semantic_planning;

namespace {

/** A floor with a slit from y = 0 to y = `width`. */
class SlitFloor : public testing::Test {
 protected:
  void paint(double width) {
    world.floor(-6, 6, -6, 0, PaintedWorld::Road);
    world.floor(-6, 6, width, 6, PaintedWorld::Grass);
  }

  Ground ground(double fillGap, double unknownGap,
                const colored_graph::ClassOrder& order = {5, {{1}, {2}, {3, 4}, {0}}}) {
    GroundOptions options;
    options.fillGap = fillGap;
    options.unknownGap = unknownGap;
    return Ground(world.map(), VehicleOptions(), options, order);
  }

  PaintedWorld world;
};

}  // namespace

TEST_F(SlitFloor, isFilledWithTheNearerBordersClassOrUnknownGroundOrStaysOpen) {
  const colored_graph::ClassOrder usual{5, {{1}, {2}, {3, 4}, {0}}}, alike{5, {{0}, {1, 2, 3, 4}}},
      forbidden{5, {{3, 4}, {0}}};
  constexpr ClassId kUnknown = semantic_types::kNoClass;
  const struct {
    const char* name;
    double width;
    const colored_graph::ClassOrder& order;
    std::vector<ClassId> classes;  ///< near the road, and near the grass; none: open
  } cases[] = {{"narrow", 0.8, usual, {PaintedWorld::Road, PaintedWorld::Grass}},
               {"wider, of ranks that differ", 1.4, usual, {kUnknown, kUnknown}},
               {"wider, of one rank", 1.4, alike, {PaintedWorld::Road, PaintedWorld::Grass}},
               {"wider, of forbidden classes", 1.4, forbidden, {kUnknown, kUnknown}},
               {"wider than all gaps", 2.4, usual, {}}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.name);
    world = PaintedWorld();
    paint(c.width);
    const Ground g = ground(1, 2, c.order);
    std::vector<ClassId> found;
    for (const double y : {0.1, c.width - 0.1})
      if (const auto at = g.find(0, y)) {
        EXPECT_TRUE(at->surface.filled);
        found.push_back(at->surface.classId);
      }
    EXPECT_EQ(found, c.classes);
    EXPECT_EQ(g.connected(*g.find(0, -1), *g.find(0, 4)), !c.classes.empty());
  }
}

TEST_F(SlitFloor, aWideFillLeavesNoFloorAboveANarrowOne) {
  paint(0.8);
  for (const double x : {-1.6, 1.2})  // their tops are joined along the slit, 0.4 m above its fill
    world.box(x, x + 0.4, 0, 0.8, 0, 0.4, PaintedWorld::Mud);
  const Ground g = ground(1, 3);
  const SurfaceRange surfaces = g.surfaces(g.columnAt(0, 0.3));
  ASSERT_EQ(surfaces.end() - surfaces.begin(), 1);
  EXPECT_TRUE(surfaces.begin()->filled);
  EXPECT_LT(g.centerOf(surfaces.begin()->z), 0);
  EXPECT_EQ(surfaces.begin()->clearance2, g.largestClearance() * g.largestClearance());
}

TEST_F(SlitFloor, whatStandsInTheSlitIsNotFilled) {
  paint(0.8);
  world.box(-6, 6, 0.4, 0.6, 0, 1, PaintedWorld::Wall);
  const Ground g = ground(1, 1);
  EXPECT_FALSE(g.connected(*g.find(0, -1), *g.find(0, 2)));
}

TEST_F(SlitFloor, aDitchIsNotFilled) {
  paint(0.8);
  world.box(-6, 6, 0, 0.8, -2, -1.8, PaintedWorld::Mud);  // seen from above: free space below
  const Ground g = ground(1, 1);
  EXPECT_FALSE(g.connected(*g.find(0, -1), *g.find(0, 2)));
}
