#include <gtest/gtest.h>
#include <semantic_driving/ViewStrategy.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "PaintedPlanner.h"
#include "ViewPlaces.h"

using namespace semantic_driving;
using mrpt::math::TPose2D;
using semantic_planning::SemanticPlanner;
using tree_abstraction::AbstractionWeights;

namespace {

/** Flat ground, 16 m by 16 m, road in the east (x > 0) and grass in the west; beyond it nothing
 * is known. Both are of one rank. */
class ViewStrategies : public testing::Test {
 protected:
  ViewStrategies() {
    world.floor(0, 8, -8, 8, PaintedWorld::Road);
    world.floor(-8, 0, -8, 8, PaintedWorld::Grass);
    options.sensor = {6, -60, 15, 80};
  }
  SemanticPlanner planner() {
    semantic_planning::PlannerOptions planning;
    planning.roadmap.kind = semantic_planning::GraphKind::HaltonDrivable;
    planning.vehicle.clearance = 0.1;
    return {world.map(), colored_graph::ClassOrder(5, {{1, 2}, {0}}), planning};
  }
  std::optional<View> firstView(const AbstractionWeights& weights, bool learned = true) {
    const SemanticPlanner over = planner();
    return relevantViews(over, world.map(), weights, options, learned)->next(kStart, 0);
  }
  static AbstractionWeights weightsOf(tree_abstraction::InformationTerm term) {
    AbstractionWeights weights;
    weights.terms = {std::move(term)};
    return weights;
  }
  static AbstractionWeights relevant(int id) {
    return weightsOf(tree_abstraction::relevant("relevant", 1, {id}));
  }

  const TPose2D kStart{0, 0, 0};
  PaintedWorld world;
  ExploreOptions options;
};

/** Sum over all legs of their length times what is not had yet, in an order. */
double costOf(const std::vector<std::size_t>& order, const std::vector<std::vector<double>>& ways,
              const std::vector<double>& worth) {
  double left = std::accumulate(worth.begin(), worth.end(), 0.0), sum = 0;
  std::size_t at = worth.size();
  for (const std::size_t stop : order) {
    sum += ways[at][stop] * left;
    left -= worth[stop], at = stop;
  }
  return sum;
}

}  // namespace

TEST(ViewTour, goesFirstWhereTheBestOfAllOrdersDoes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(0.1, 10);
  for (int trial = 0; trial < 50; ++trial) {
    const std::size_t n = 1 + static_cast<std::size_t>(trial) % 6;
    std::vector<std::vector<double>> ways(n + 1, std::vector<double>(n));
    std::vector<double> worth(n);
    for (auto& row : ways)
      for (double& way : row) way = number(random);
    for (double& w : worth) w = number(random);
    std::vector<std::size_t> order(n), best;
    std::iota(order.begin(), order.end(), 0);
    double least = std::numeric_limits<double>::infinity();
    do {
      const double cost = costOf(order, ways, worth);
      if (cost < least) least = cost, best = order;
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_EQ(firstStop(ways, worth), best.front()) << "trial " << trial;
  }
}

TEST_F(ViewStrategies, lookForWhatMattersWhereItIsLikely) {
  const auto east = firstView(relevant(PaintedWorld::Road));
  const auto west = firstView(relevant(PaintedWorld::Grass));
  ASSERT_TRUE(east && west);
  EXPECT_GT(east->pose.x, 1);
  EXPECT_LT(west->pose.x, -1);
  EXPECT_GT(east->promise, 0);
}

TEST_F(ViewStrategies, doNotDriveForWhatIsOnlyToBeIgnored) {
  EXPECT_FALSE(firstView(weightsOf(
      tree_abstraction::irrelevant("ignored", 1, {static_cast<int>(PaintedWorld::Road)}))));
}

TEST_F(ViewStrategies, lookForGroundBelowWhereItWasExpectedIfThatIsFree) {
  constexpr double kEdge = 8, kFar = 15, kStep = 0.1;  // m
  const auto expected = firstView(relevant(PaintedWorld::Road));
  for (const double side : {0.0, 0.5, 1.0, 1.5}) {  // half turns
    const Eigen::AngleAxisd turn(side * M_PI, Eigen::Vector3d::UnitZ());
    for (double y = -kFar; y < kFar; y += kStep)
      for (const double z : {0.1, -0.1, -0.3}) {
        if (turn.matrix()(0, 0) * turn.matrix()(0, 0) < 0.5 && std::abs(y) > kEdge) continue;
        semantic_types::LabeledCloud beyond;
        beyond.points.emplace_back(kFar - kEdge + 1, 0.F, 0.F);
        beyond.classes.push_back(PaintedWorld::Grass);
        Eigen::Isometry3d T(turn);
        T.translation() = turn * Eigen::Vector3d(kEdge + 0.1, y + 0.05, z);
        semantic_octree::InsertionOptions carving;
        carving.maxRange = kFar - kEdge;
        world.map().insert(beyond, T, carving);
      }
  }
  const auto view = firstView(relevant(PaintedWorld::Road));
  ASSERT_TRUE(expected && view);
  EXPECT_GT(view->pose.x, 1);
  EXPECT_GT(view->promise, expected->promise / 2);
}

namespace {

/** What is left to see of walls 3 m beyond the edge of a road, where a wall was seen at the edge,
 * between two heights (m). */
double leftOfWalls(double low, double high) {
  PaintedWorld world;
  world.floor(-8, 8, -8, 8, PaintedWorld::Road).box(8, 8.4, -8, 8, low, high, PaintedWorld::Wall);
  const SemanticPlanner over = plannerOver(world);
  AbstractionWeights weights;
  weights.terms = {tree_abstraction::relevant("walls", 1, {PaintedWorld::Wall})};
  ExploreOptions options;
  options.sensor = {6, -60, 15, 80};
  const auto strategy = relevantViews(over, world.map(), weights, options);
  strategy->next({0, 0, 0}, 0);
  return strategy->left(over.ground().columnAt(11, 0));
}

}  // namespace

TEST(RelevantViews, expectThingsNearThoseThatRiseFromTheGround) {
  const double roof = leftOfWalls(2.2, 2.4), notConnectedYet = leftOfWalls(0.8, 1);
  EXPECT_GT(leftOfWalls(0, 1.2), 2 * roof);
  EXPECT_GT(leftOfWalls(0.2, 1.2), 2 * roof);  // as a car's body
  EXPECT_NEAR(notConnectedYet, roof, 0.01 * roof);
}

TEST_F(ViewStrategies, neverChooseAViewTwice) {
  const SemanticPlanner over = planner();
  for (const auto& strategy :
       {nearestFrontier(over, options),
        relevantViews(over, world.map(), relevant(PaintedWorld::Road), options)}) {
    std::vector<TPose2D> seen;
    double most = 0;
    while (const auto view = strategy->next(kStart, 0)) {
      for (const TPose2D& before : seen)
        EXPECT_FALSE(std::hypot(before.x - view->pose.x, before.y - view->pose.y) < 2.4 &&
                     std::cos(before.phi - view->pose.phi) > 0.9);
      const view_information::Bounds growth = strategy->growth();
      EXPECT_LE(growth.lower, growth.upper);
      most = std::max(most, growth.upper);
      seen.push_back(view->pose);
      strategy->done(*view);
      ASSERT_LT(seen.size(), 500U);
    }
    EXPECT_GT(seen.size(), 3U);
    EXPECT_NE(strategy->conclusion().find("left within reach"), std::string::npos);
    EXPECT_EQ(most > 0, strategy->conclusion().find("tree's objective") != std::string::npos);
  }
}

TEST_F(ViewStrategies, theNearestFrontierIsAtTheBorderOfWhatIsKnown) {
  const SemanticPlanner over = planner();
  const auto view = nearestFrontier(over, options)->next({3, 0, 0}, 0);
  ASSERT_TRUE(view);
  EXPECT_GT(view->pose.x, 5.5);
  EXPECT_NEAR(view->pose.phi, 0, 0.8);
}

TEST_F(ViewStrategies, stayWithinTheirArea) {
  options.area = Eigen::AlignedBox2d(Eigen::Vector2d(-8, -8), Eigen::Vector2d(0, 8));
  const auto view = firstView(relevant(PaintedWorld::Road));
  EXPECT_TRUE(!view || view->pose.x <= 0);
}
