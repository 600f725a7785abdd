#include <gtest/gtest.h>
#include <semantic_driving/DriveGuide.h>
#include <semantic_driving/Explorer.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "PaintedPlanner.h"
#include "Plain.h"
#include "Trial.h"
#include "simulated_drive/DriveLoop.h"

using namespace semantic_driving;
using namespace semantic_planning;
using mrpt::math::TPose2D;

namespace {

/** Flat ground, 16 m by 16 m, and beyond it nothing that is known. Grass is on rank 1. */
class Frontiers : public testing::Test {
 protected:
  Frontiers() { world.floor(-8, 8, -8, 8, PaintedWorld::Road); }

  Exploration explore(const TPose2D& goal, const std::vector<TPose2D>& avoid = {}) {
    return findFrontiers(plannerOver(world), kStart, 0, goal, avoid);
  }
  void wall(double x0, double x1, double y0, double y1) {
    world.box(x0, x1, y0, y1, 0, 1, PaintedWorld::Wall);
  }

  const TPose2D kStart{0.1, 0.1, 0};
  PaintedWorld world;
};

double distance(const TPose2D& a, const TPose2D& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/** Far ahead of the start: the first meter of a shortest way leads straight on. */
bool isAhead(const TPose2D& pose) { return pose.x > 6.4 && pose.x - std::abs(pose.y) > 1.4; }

/** The shortest way from column to column over eight neighbors on free ground. */
double octile(const TPose2D& a, const TPose2D& b) {
  const double x = std::abs(a.x - b.x), y = std::abs(a.y - b.y);
  return std::max(x, y) + (std::sqrt(2.0) - 1) * std::min(x, y);
}

TEST_F(Frontiers, LieAtTheBorderOfWhatIsKnownAndApart) {
  const Exploration found = explore({30, 0, 0});
  ASSERT_EQ(found.frontiers.size(), 6u);
  EXPECT_FALSE(found.enclosed);
  EXPECT_EQ(found.goalArea, std::numeric_limits<double>::infinity());
  for (const Frontier& f : found.frontiers) {
    const double toBorder = 8 - std::max(std::abs(f.pose.x), std::abs(f.pose.y));
    EXPECT_GT(toBorder, 0.3);  // the vehicle fits
    EXPECT_LE(toBorder, 1.5);  // the unknown is in sight
    for (const Frontier& other : found.frontiers) {
      if (&other != &f) {
        EXPECT_GE(distance(f.pose, other.pose), 3);
      }
    }
  }
}

TEST_F(Frontiers, CostTheWayThereAndTwiceThatThroughTheUnknown) {
  const TPose2D goal(30.1, 4.1, 0);
  const Exploration found = explore(goal);
  ASSERT_FALSE(found.frontiers.empty());
  double before = 0;
  int ahead = 0;
  for (const Frontier& f : found.frontiers) {
    EXPECT_GE(f.cost, before);  // most promising first
    before = f.cost;
    if (!isAhead(f.pose)) continue;
    ++ahead;
    EXPECT_NEAR(f.cost, octile(kStart, f.pose) + 2 * octile(f.pose, goal), 1e-6);
  }
  EXPECT_GE(ahead, 2);
}

TEST_F(Frontiers, OfAGoalAMillionKilometersAwayAreThoseTowardsIt) {
  for (const double side : {1.0, -1.0}) {
    const Exploration found = explore({side * 1e9, 0, 0});
    ASSERT_FALSE(found.frontiers.empty());
    EXPECT_GT(side * found.frontiers[0].pose.x, 6);
    EXPECT_NEAR(found.hoped, 2e9, 10);
  }
}

TEST_F(Frontiers, OverWorseClassesCostTheirRankMore) {
  world.floor(-8, 8, -8, 8, PaintedWorld::Grass);
  const TPose2D goal(30.1, 4.1, 0);
  const Exploration found = explore(goal);
  ASSERT_FALSE(found.frontiers.empty());
  for (const Frontier& f : found.frontiers)
    if (isAhead(f.pose)) {
      EXPECT_NEAR(f.cost, 2 * octile(kStart, f.pose) + 2 * octile(f.pose, goal), 1e-6);
    }
}

TEST_F(Frontiers, CostMoreOfTheUnknownTheMoreItWasHopedForInVain) {
  const TPose2D goal(30.1, 4.1, 0);
  const Exploration first = explore(goal);
  const Effort asHoped{7, first.hoped + 7}, inVain{50, first.hoped};
  const auto again = findFrontiers(plannerOver(world), kStart, 0, goal, {}, asHoped);
  ASSERT_EQ(again.frontiers.size(), first.frontiers.size());
  for (std::size_t i = 0; i < first.frontiers.size(); ++i)
    EXPECT_EQ(again.frontiers[i].cost, first.frontiers[i].cost);
  const auto doubted = findFrontiers(plannerOver(world), kStart, 0, goal, {}, inVain);
  EXPECT_EQ(doubted.hoped, first.hoped);
  const double doubt = std::sqrt((50 + first.hoped) / first.hoped);
  for (const Frontier& f : doubted.frontiers)
    if (isAhead(f.pose)) {
      EXPECT_NEAR(f.cost, octile(kStart, f.pose) + 2 * doubt * octile(f.pose, goal), 1e-6);
    }
}

TEST_F(Frontiers, WhereTheVehicleDoesNotHeadCostWhatTurningAroundDoes) {
  constexpr double kTurning = 4;  // m
  const TPose2D behind(-30, 0.1, 0);
  const auto leastFrom = [&](double heading) {
    const auto found = findFrontiers(plannerOver(world), {0.1, 0.1, heading}, 0, behind, {});
    return found.frontiers.at(0).cost;
  };
  EXPECT_GT(leastFrom(0), leastFrom(M_PI) + kTurning / 2);
  EXPECT_LE(leastFrom(0), leastFrom(M_PI) + kTurning + 1e-9);
}

TEST_F(Frontiers, OfTwoAsGoodOnesTheOneAheadComesFirst) {
  wall(-8, 8, 1.4, 1.8), wall(-8, 8, -1.6, -1.2);  // a street; its ends are as far from the goal
  for (const double heading : {0.0, M_PI}) {
    const auto found = findFrontiers(plannerOver(world), {0.1, 0.1, heading}, 0, {0.1, 30, 0}, {});
    ASSERT_FALSE(found.frontiers.empty());
    EXPECT_GT(found.frontiers[0].pose.x * std::cos(heading), 6);
  }
}

TEST_F(Frontiers, AreWhereNobodySawTheGroundAlthoughRaysWentAbove) {
  semantic_types::LabeledCloud rays;  // 0.3 m above the ground, to beyond all that matters
  for (double a = -1; a < 1; a += 0.01)
    rays.points.push_back(Eigen::Vector3d(60 * std::cos(a), 60 * std::sin(a), 0).cast<float>());
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  T_map_sensor.translation() << 6, 0, 0.3;
  world.map().insert(rays, T_map_sensor);
  const Exploration found = explore({30, 0, 0});
  ASSERT_FALSE(found.frontiers.empty());
  EXPECT_GT(found.frontiers[0].pose.x, 6);
  EXPECT_LT(std::abs(found.frontiers[0].pose.y), 3);
}

TEST_F(Frontiers, BehindWhatIsInTheWayToTheGoalCostTheWayAround) {
  const TPose2D goal(20.1, 0.1, 0);
  wall(7.6, 8, -8, 4);  // its end is at the left
  const Exploration found = explore(goal);
  ASSERT_FALSE(found.frontiers.empty());
  EXPECT_GT(found.frontiers[0].pose.y, 4);
  for (const Frontier& f : found.frontiers)
    if (f.pose.y < 4 && f.pose.x > -6) {  // out at the right, and around below
      EXPECT_GT(f.cost, octile(kStart, f.pose) + 2 * octile(f.pose, {8.1, -8.1, 0}));
    }
}

TEST_F(Frontiers, OfAWideVehicleAreNotBeyondAGapThatItDoesNotFitThrough) {
  wall(3, 3.2, -8, -0.6), wall(3, 3.2, 0.8, 8);  // a gap of 1.4 m
  PlannerOptions options;
  options.roadmap.kind = GraphKind::HaltonDrivable;
  const auto farthest = [&](const Footprint& footprint) {
    options.vehicle.footprint = footprint;
    const SemanticPlanner planner(world.map(), colored_graph::ClassOrder(5, {{1}, {2}, {0}}),
                                  options);
    double x = -8;
    for (const Frontier& f : findFrontiers(planner, kStart, 0, {30, 0, 0}, {}).frontiers)
      x = std::max(x, f.pose.x);
    return x;
  };
  EXPECT_GT(farthest(Footprint::rectangle(-0.25, 0.55, 0.6)), 4);
  EXPECT_LT(farthest(Footprint::rectangle(-0.25, 0.55, 1.6)), 3);
  // As wide, but mostly to the left of its origin.
  EXPECT_LT(farthest(Footprint({{-0.25, -0.2}, {0.55, -0.2}, {0.55, 1.4}, {-0.25, 1.4}})), 3);
}

TEST_F(Frontiers, HeadAsOneComesThere) {
  const Exploration found = explore({30, 0.1, 0});
  ASSERT_FALSE(found.frontiers.empty());
  EXPECT_NEAR(found.frontiers[0].pose.phi, 0, 0.4);
  EXPECT_GT(found.frontiers[0].pose.x, 6);
}

TEST_F(Frontiers, AreNotLookedForAgain) {
  const Exploration first = explore({30, 0, 0});
  ASSERT_FALSE(first.frontiers.empty());
  const TPose2D seen = first.frontiers[0].pose;
  for (const Frontier& f : explore({30, 0, 0}, {seen}).frontiers)
    EXPECT_GE(distance(f.pose, seen), 3);
}

TEST_F(Frontiers, FarFromAGoalThatIsReachedAreOfNoUseToWhoWasThere) {
  world.floor(-12, 12, -12, 12, PaintedWorld::Road);
  SemanticPlanner planner = plannerOver(world);
  Explorer explorer(planner);
  const TPose2D goal(0.1, 0.1, 0), far(-11, 0.1, 0), near(2, 0.1, 0);
  EXPECT_FALSE(explorer.places(far, 0, goal).frontiers.empty());
  EXPECT_FALSE(explorer.exhausted());
  EXPECT_TRUE(explorer.places(near, 0, goal).frontiers.empty());
  EXPECT_TRUE(explorer.exhausted());
  EXPECT_TRUE(explorer.places(far, 0, goal).frontiers.empty()) << "it was there";
  EXPECT_FALSE(explorer.places(near, 0, {30, 0, 0}).frontiers.empty())
      << "known ground ends before";
  EXPECT_FALSE(explorer.exhausted());
}

TEST_F(Frontiers, AreChosenAlikeInSlicesOfAnySize) {
  SemanticPlanner planner = plannerOver(world);
  const TPose2D goal(30, 4, 0);
  const auto asPlanned = [](DrivePath path) { return path; };
  const auto choose = [&](std::size_t slice) {
    Explorer explorer(planner);
    explorer.begin(kStart, 0, goal);
    int slices = 1;
    for (std::size_t work = slice; !explorer.goOn(asPlanned, work); work = slice) ++slices;
    return std::make_pair(slices, explorer.chosen(true));
  };
  const auto [one, whole] = choose(std::numeric_limits<std::size_t>::max());
  const auto [many, sliced] = choose(1000);
  ASSERT_TRUE(whole && sliced);
  EXPECT_EQ(one, 1);
  EXPECT_GT(many, 5) << "it reaches some 5000 columns";
  EXPECT_EQ(sliced->plan.price, whole->plan.price);
  EXPECT_EQ(distance(poseOf(sliced->path.at(1e9)), poseOf(whole->path.at(1e9))), 0);
}

TEST_F(Frontiers, AreNotLookedForOnceAGuideIsToldToStop) {
  world.floor(-50, 50, -50, 50, PaintedWorld::Road);
  SemanticPlanner planner = plannerOver(world);
  DriveGuide guide({}, planner, {90, 0, 0});
  ReactiveNavigator::Options reactive;
  reactive.config = std::string(MSO_SOURCE_DIR) + "/config/reactive/robot.ini";
  DriveController drive({}, reactive);
  const DriveState state{kStart};
  guide.update(state, 0, drive, 0);
  ASSERT_TRUE(guide.isSearching());
  EXPECT_TRUE(drive.tracker().path().empty());
  guide.stopSearching();
  EXPECT_FALSE(guide.isSearching());
  for (int i = 1; i < 50 && drive.tracker().path().empty(); ++i) guide.update(state, 0, drive, i);
  EXPECT_EQ(guide.target(), Target::Frontier) << "it looks anew";
}

TEST_F(Frontiers, BehindAWallAreNone) {
  wall(4, 4.2, -8, 8);
  for (const Frontier& f : explore({30, 0, 0}).frontiers) EXPECT_LT(f.pose.x, 4);
}

TEST_F(Frontiers, WithinWallsThereAreNoneAndTheVehicleIsEnclosed) {
  wall(-4, 4, -4, -3.8), wall(-4, 4, 3.8, 4), wall(-4, -3.8, -4, 4), wall(3.8, 4, -4, 4);
  const Exploration found = explore({30, 0, 0});
  EXPECT_TRUE(found.enclosed);
  EXPECT_TRUE(found.frontiers.empty());
  EXPECT_EQ(found.goalArea, std::numeric_limits<double>::infinity());
}

TEST_F(Frontiers, AGoalWithinWallsIsEnclosedOnAnAreaOfTheirs) {
  wall(3, 7, 3, 3.2), wall(3, 7, 6.8, 7), wall(3, 3.2, 3, 7), wall(6.8, 7, 3, 7);
  const Exploration found = explore({5.1, 5.1, 0});
  EXPECT_TRUE(found.enclosed);
  // Within 3.2 to 6.8 m, but for the columns next to a wall: 0.35 m are kept.
  EXPECT_NEAR(found.goalArea, 3.2 * 3.2, 1e-6);
}

using namespace drive_study;
using Eigen::Vector2d;

constexpr double kHalf = 30, kFar = 60;  // m

/** A garden with a goal behind a hedge. */
struct Garden {
  synthetic_world::World world;
  TPose2D start, goal;
};

/** A bent hedge between start and goal, which are 11 to 15 m apart. It ends 6 to 20 m aside, half
 * of the time with a hook. On the other side it ends after 6 to 20 m or at the border. A road leads
 * along both sides and, mostly, around the end. */
Garden garden(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  const double side = between(0, 1) < 0.5 ? -1 : 1;
  const double end = between(6, 20), other = between(0, 1) < 0.5 ? kHalf : between(end, 22);
  std::vector<Vector2d> hedge;
  for (double y = -other; y < end - 1; y += 4)
    hedge.emplace_back(std::abs(y) < 3 ? 0 : between(-1.5, 1.5), y);
  hedge.emplace_back(0, end);
  if (between(0, 1) < 0.5)
    hedge.emplace_back(between(0, 1) < 0.5 ? -between(2, 5) : between(2, 5), end - between(0, 4));
  synthetic_world::Solids solids;
  for (std::size_t i = 1; i < hedge.size(); ++i) {
    const Vector2d a = hedge[i - 1], b = hedge[i];
    const auto panel =
        synthetic_world::hedgePanel({a.x(), side * a.y(), 0}, {b.x(), side * b.y(), 0});
    solids.insert(solids.end(), panel.begin(), panel.end());
  }
  const double left = between(-8, -5.5), right = between(5.5, 8), turn = end + between(3, 5);
  synthetic_world::GroundCover cover(kHalf, synthetic_world::kGrass);
  const auto road = [&](const Vector2d& a, const Vector2d& b) {
    cover.paintBand(synthetic_world::kRoad, {a.x(), side * a.y()}, {b.x(), side * b.y()}, 4);
  };
  road({left, -28}, {left, 28}), road({right, -28}, {right, 28});
  if (between(0, 1) < 0.7) road({left, turn}, {right, turn});
  return {synthetic_world::World(synthetic_world::Terrain(kHalf, {}), cover, std::move(solids)),
          {left, 0, between(-M_PI, M_PI)},
          {right, 0, between(-M_PI, M_PI)}};
}

/** A goal behind a hedge that ends 25 m behind the robot, and ahead at the garden's border. So
 * there is always hope for a gap just beyond what is seen. */
Garden lane() {
  synthetic_world::Solids solids;
  for (double y = -25; y < kFar; y += 5) {
    const auto panel = synthetic_world::hedgePanel({0, y, 0}, {0, y + 5, 0});
    solids.insert(solids.end(), panel.begin(), panel.end());
  }
  synthetic_world::GroundCover cover(kFar, synthetic_world::kGrass);
  for (const double x : {-6.0, 6.0})
    cover.paintBand(synthetic_world::kRoad, {x, -28}, {x, kFar - 2}, 4);
  return {synthetic_world::World(synthetic_world::Terrain(kFar, {}), cover, std::move(solids)),
          {-6, 0, M_PI / 2},
          {6, 8, M_PI / 2}};
}

/** How many gardens: MSO_HEDGES of the environment, or a few. */
std::uint32_t gardens() {
  const char* text = std::getenv("MSO_HEDGES");
  return text ? static_cast<std::uint32_t>(std::atoi(text)) : 3;
}

}  // namespace

TEST(Hedges, DoNotKeepARobotFromAGoalBehindThem) {
  const auto order = syntheticOrder();
  auto config = smallConfig();
  config.timeLimit = 400;
  std::uint32_t within = 0;
  for (std::uint32_t seed = 1; seed <= gardens(); ++seed) {
    Garden g = garden(seed);
    Task task;
    task.start = g.start, task.goal = g.goal;
    Oracle(g.world, order, config.planner, config.voxelSize).solve(task);
    ASSERT_TRUE(task.hasPath) << seed << ": " << task.reason;
    simulated_drive::DriveLoop loop(config, g.world, order, g.start, g.goal, {});
    const simulated_drive::DriveRecord& record = loop.run();
    EXPECT_EQ(record.end, simulated_drive::DriveEnd::Arrived) << seed << ": " << record.reason;
    EXPECT_EQ(record.collisions, 0) << seed;
    RecordProperty("meters_of_garden_" + std::to_string(seed),
                   std::to_string(record.length) + " of " + std::to_string(task.length));
    within += record.arrived() && record.length <= 3 * task.length ? 1 : 0;
  }
  EXPECT_GE(10 * within, 9 * gardens());
}

TEST(Hedges, AreNotFollowedToTheirEndHoweverFar) {
  auto config = smallConfig();
  config.timeLimit = 400;
  Garden g = lane();
  const auto order = syntheticOrder();
  simulated_drive::DriveLoop loop(config, g.world, order, g.start, g.goal, {});
  const simulated_drive::DriveRecord& record = loop.run();
  EXPECT_EQ(record.end, simulated_drive::DriveEnd::Arrived) << record.reason;
  double farthest = 0;
  for (const simulated_drive::DriveRow& row : record.rows)
    farthest = std::max(farthest, row.pose.y);
  RecordProperty("farthest", std::to_string(farthest));
  RecordProperty("driven", std::to_string(record.length));
  EXPECT_LT(farthest, 0.6 * kFar);
}
