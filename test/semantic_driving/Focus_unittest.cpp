#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_driving/PathTracker.h>
#include <semantic_planning/planner/OrderFile.h>

#include <algorithm>
#include <cmath>

#include "Plain.h"
#include "simulated_drive/DriveLoop.h"

using namespace semantic_driving;
using semantic_octree::Region;
using semantic_octree::SemanticOcTree;
using simulated_drive::DriveLoop;

namespace {

FocusOptions someFocus() {
  FocusOptions focus;
  focus.corridor = 1.5, focus.around = 4;
  return focus;
}

/** 20 m to the east, 20 m to the north. */
DrivePath bentPath() {
  std::vector<semantic_planning::PathPoint> points;
  const auto add = [&points](double x, double y, double heading) {
    points.push_back({});
    points.back().x = x, points.back().y = y, points.back().heading = heading;
  };
  for (int i = 0; i <= 40; ++i) add(i * 0.5, 0, 0);
  for (int i = 1; i <= 40; ++i) add(20, i * 0.5, M_PI / 2);
  return DrivePath(std::move(points));
}

bool isIn(const Region& r, const Eigen::Vector3d& p) {
  if (r.shape == Region::Shape::Box) return (p.array() >= r.a.array()).all();
  double nearest = (p - r.a).norm();
  for (int k = 1; r.shape == Region::Shape::Corridor && k <= 100; ++k)
    nearest = std::min(nearest, (p - r.a - k / 100. * (r.b - r.a)).norm());
  return nearest <= r.radius;
}

double densityAt(const std::vector<Region>& regions, double x, double y) {
  double largest = -1;
  for (const Region& r : regions)
    if (isIn(r, {x, y, 0})) largest = std::max(largest, r.weight);
  return largest < 0 ? 1 : largest;
}

/** Compares the compressed tree with one made of the same map anew, and with one without focus. */
class FromScratch : public simulated_drive::DriveObserver {
 public:
  void onSensed(const DriveLoop& loop, const std::vector<simulated_drive::Observation>&) override {
    SemanticOcTree anew = loop.mapper().map();
    auto options = semantic_planning::abstractionFor(syntheticOrder());
    options.regions = semantic_octree::Abstraction(anew).options().regions;
    dropAbstraction(anew);
    setAbstraction(anew, options);
    same += anew == loop.mapper().map();
    ++compared;
    corridors = std::max(corridors, options.regions.size() - 2);
    leaves += semantic_octree::Abstraction(anew).leaves().size();
    semantic_octree::Abstraction(anew).setRegions({});
    leavesWithout += semantic_octree::Abstraction(anew).leaves().size();
  }

  int compared = 0, same = 0;
  std::size_t corridors = 0, leaves = 0, leavesWithout = 0;
};

}  // namespace

TEST(Focus, IsAroundTheVehicleAndAlongThePathAhead) {
  const DrivePath path = bentPath();
  for (const double progress : {0.0, 5.3, 17.0, 33.0, 39.5}) {
    const auto p = path.at(progress);
    const auto regions = regionsAhead(path, progress, {p.x, p.y, 0}, someFocus());
    for (double x = -10; x < 30; x += 0.73)
      for (double y = -10; y < 30; y += 0.73) {
        double toPath = 1e9, toLongerPath = 1e9;
        for (double s = progress; s <= std::min(progress + 15, 40.0); s += 0.05)
          toPath = std::min(toPath, std::hypot(path.at(s).x - x, path.at(s).y - y));
        for (double s = std::max(0.0, progress - 3); s <= std::min(progress + 18, 40.0); s += 0.05)
          toLongerPath = std::min(toLongerPath, std::hypot(path.at(s).x - x, path.at(s).y - y));
        const double toVehicle = std::hypot(p.x - x, p.y - y);
        const double density = densityAt(regions, x, y);
        // A stretch of 3 m cuts the bend's corner by 2 * 1 / sqrt(5) m = 0.9 m at most.
        if (toPath < 0.6 || toVehicle < 4) {
          EXPECT_EQ(density, 1) << progress << ": " << x << ", " << y;
        }
        if (toLongerPath > 2.0 && toVehicle > 4 + 2 * std::sqrt(0.75)) {
          EXPECT_EQ(density, 0) << progress << ": " << x << ", " << y;
        }
      }
  }
  EXPECT_TRUE(regionsAhead(path, 0, {0, 0, 0}, {}).empty());
  EXPECT_EQ(regionsAhead({}, 0, {0, 0, 0}, someFocus()).size(), 2u);
}

TEST(Focus, MovesWithTheDriveAndTheTreeIsThatOfTheMapCompressedAnewToTheLastBit) {
  auto config = smallConfig();
  config.focus = someFocus();
  synthetic_world::Solids solids;
  addWall(solids, {0, -6}, {0, -1});
  synthetic_world::World world = plain(solids);
  DriveLoop loop(config, world, syntheticOrder(), {-8, -2, 0}, {8, -2, 0}, {});
  FromScratch fromScratch;
  loop.addObserver(fromScratch);
  const auto record = loop.run();
  EXPECT_TRUE(record.arrived()) << record.reason;
  EXPECT_EQ(record.collisions, 0);
  EXPECT_GT(fromScratch.compared, 20);
  EXPECT_EQ(fromScratch.same, fromScratch.compared);
  EXPECT_GE(fromScratch.corridors, 3u);
  EXPECT_LT(fromScratch.leaves, fromScratch.leavesWithout / 2);
  EXPECT_EQ(record.leaves.size(), static_cast<std::size_t>(fromScratch.compared));
}
