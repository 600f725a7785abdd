#include "planner/RelaxedField.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <random>

#include "PlannerFixture.h"
#include "ground/SurfaceTile.h"

using namespace semantic_planning;

namespace {

class RelaxedSearch : public PlannerTest {
 protected:
  RelaxedPath search() {
    const Ground ground(map(), options.vehicle, options.ground, order);
    const CollisionChecker checker(ground, options.vehicle, order);
    return searchRelaxed(checker, *checker.place(start), *checker.place(goal));
  }
  std::vector<PathPoint> guide() { return search().path; }
  static double meters(const std::vector<PathPoint>& path, PaintedWorld::Class id) {
    return PlannerTest::meters(path, [id](const PathPoint& p) { return p.classId == id; });
  }
};

/** Square patches of road, grass and mud, with mud around them. Places are numbered row by row. */
class Patches {
 public:
  /** \param edge of a patch, voxels */
  Patches(PaintedWorld& world, int edge, std::mt19937& random) : m_rank(kEdge * kEdge, 2) {
    const PaintedWorld::Class classes[] = {PaintedWorld::Road, PaintedWorld::Grass,
                                           PaintedWorld::Mud};
    world.floor(-8, 8, -8, 8, PaintedWorld::Mud);
    for (int y = kBorder; y + edge <= kEdge - kBorder; y += edge)
      for (int x = kBorder; x + edge <= kEdge - kBorder; x += edge) {
        const int rank = static_cast<int>(random() % 3);
        for (int i = 0; i < edge * edge; ++i) {
          const int vx = x + i % edge, vy = y + i / edge;
          m_rank[static_cast<std::size_t>(vy * kEdge + vx)] = rank;
          world.voxel(vx - kEdge / 2, vy - kEdge / 2, -1, classes[rank]);
        }
      }
  }

  /** \param stride from keys that are multiples of it it leads to such */
  int anywhere(std::mt19937& random, int stride) const {
    const auto inside = [&] {
      return int(kBorder + random() % (kEdge - 2 * kBorder)) / stride * stride;
    };
    const int y = inside();
    return y * kEdge + inside();
  }
  mrpt::math::TPose2D poseAt(int place) const {
    const auto at = [](int key) { return (key - kEdge / 2 + 0.5) * 0.2; };
    return {at(place % kEdge), at(place / kEdge), 0};
  }

  /** Dijkstra's, in steps of 5 straight on and 7 aslant, `stride` times that. */
  std::int64_t leastCost(int from, int to, int stride,
                         const std::vector<std::int64_t>& weights) const {
    using Reached = std::pair<std::int64_t, int>;
    std::vector<std::int64_t> least(m_rank.size(), std::numeric_limits<std::int64_t>::max());
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
    const auto reach = [&](int place, std::int64_t cost) {
      if (cost >= least[static_cast<std::size_t>(place)]) return;
      least[static_cast<std::size_t>(place)] = cost;
      queue.push({cost, place});
    };
    reach(from, 0);
    while (!queue.empty()) {
      const auto [cost, place] = queue.top();
      queue.pop();
      if (cost > least[static_cast<std::size_t>(place)]) continue;
      for (int dy = -stride; dy <= stride; dy += stride)
        for (int dx = -stride; dx <= stride; dx += stride) {
          const int x = place % kEdge + dx, y = place / kEdge + dy;
          if (x < 0 || y < 0 || x >= kEdge || y >= kEdge) continue;
          int rank = 0;  // the worst on the way
          for (int i = 0; i < stride; ++i)
            rank = std::max(rank, m_rank[static_cast<std::size_t>((y - i * dy / stride) * kEdge +
                                                                  x - i * dx / stride)]);
          reach(y * kEdge + x, cost + stride * (dx && dy ? 7 : 5) * weights[std::size_t(rank)]);
        }
    }
    return least[static_cast<std::size_t>(to)];
  }

 private:
  static constexpr int kEdge = 60, kBorder = 4;  // voxels
  std::vector<int> m_rank;
};

}  // namespace

TEST_F(RelaxedSearch, withAStrictOrderGoesAroundOverTheBetterClassHoweverFar) {
  paintCorner();
  order = order.strict();
  const auto path = guide();
  ASSERT_FALSE(path.empty());
  EXPECT_EQ(meters(path, PaintedWorld::Grass), 0);
  EXPECT_GT(path.back().arcLength, 38);
  order = {5, {{1, 2}, {4}, {0}}};
  const double straight = std::hypot(goal.x - start.x, goal.y - start.y);
  EXPECT_LT(guide().back().arcLength, 1.09 * straight);  // in eight directions
}

TEST_F(RelaxedSearch, findsTheOnlyWayAroundTheWorstClassAndThePathFollows) {
  paintCorner();
  world.floor(-15, 15, 0, 1.4, PaintedWorld::Mud);
  world.floor(2, 6, 0, 1.4, PaintedWorld::Grass);  // the only way through
  order = order.strict();
  EXPECT_EQ(meters(guide(), PaintedWorld::Mud), 0);
  options.shorten = true;
  EXPECT_LE(PlannerTest::meters(plan(), PaintedWorld::Mud), 0.2);
}

TEST_F(RelaxedSearch, anInfiniteBufferTakesAllOfTheMapWhateverTheGraph) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
  start = {-5, -13, 0};
  goal = {5, -13, 0};
  options.roadmap.buffer = std::numeric_limits<double>::infinity();
  for (const auto& [name, kind] : choicesOf(GraphKind())) {
    options.roadmap.kind = kind;
    EXPECT_TRUE(plan().found()) << name;
  }
}

TEST_F(RelaxedSearch, tellsItsPriceWhichIsDrivingAndARateForEachMeterOfARank) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Road);
  world.floor(-3, -1, -15, 15, PaintedWorld::Grass);
  world.floor(4, 5, -15, 15, PaintedWorld::Mud);
  start = {-10, 0.1, 0};
  goal = {10, 0.1, 0};
  order = order.withRates({5, 20, 30});
  EXPECT_NEAR(search().price, 20 + 2 * 5 + 1 * 20, 0.21 * 25);
}

TEST_F(RelaxedSearch, withoutAWayTellsTheNearestPlaceThatCanBeReached) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
  world.box(-1, -0.6, -15, 4, 0, 2, PaintedWorld::Wall);
  world.box(-1, -0.6, 4.6, 15, 0, 2, PaintedWorld::Wall);  // a gap that is too narrow
  start = {-10, 4.3, 0};
  goal = {10, 4.3, 0};
  EXPECT_TRUE(guide().empty());
  const auto nearest = search().nearest;
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->x, -1 - 0.5, 0.41);
  EXPECT_NEAR(nearest->y, 4.3, 0.2);
}

TEST_F(RelaxedSearch, eachDrivableSurfaceHasANameInTheOrderOfTilesColumnsAndHeights) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
  world.box(-4, 4, -2, 2, 2, 2.2, PaintedWorld::Road);  // a bridge
  const Ground ground(map(), options.vehicle, options.ground, order);
  const CollisionChecker checker(ground, options.vehicle, order);
  RelaxedField field(checker);
  RelaxedField::Cell before;
  int upon = 0;
  for (const Column& tile : ground.tiles())
    forColumnsOf(tile, [&](Column c) {
      for (const Surface& s : ground.surfaces(c)) {
        if (!s.drivable) continue;
        const RelaxedField::Place place = field.placeNear(c, s.z, 0);
        ASSERT_EQ(place.surface, &s);
        EXPECT_TRUE(place.column == c);
        EXPECT_EQ(field.placeOf(place.cell).surface, &s);
        EXPECT_TRUE(field.placeOf(place.cell).column == c);
        EXPECT_TRUE(before < place.cell);
        EXPECT_EQ(field.label(place.cell).cost, RelaxedField::kUnreached);
        field.label(place.cell).cost = 0;
        before = place.cell;
        upon += ground.surfaces(c).first != &s;
      }
    });
  EXPECT_GT(upon, 200);
}

/** Against a search in all directions, which knows no bound of what is to come. */
TEST_F(RelaxedSearch, noWayBetweenAnyPlacesCostsLess) {
  options.vehicle.wheelTrack = 0;
  const std::vector<std::int64_t> weights = weightsOfRanks(order);
  std::mt19937 random(3);
  for (int round = 0; round < 24; ++round) {
    const int stride = 1 + round % 2;
    options.vehicle.footprint = Footprint::rectangle(-0.25, 0.55, stride == 2 ? 0.6 : 0.2);
    world = PaintedWorld();
    const Patches patches(world, (std::array{2, 3, 4, 5, 8, 16}[std::size_t(round / 2 % 6)]),
                          random);
    const int from = patches.anywhere(random, stride), to = patches.anywhere(random, stride);
    start = patches.poseAt(from);
    goal = patches.poseAt(to);
    // In sixteenths of a fifth of a voxel.
    const auto least = patches.leastCost(from, to, stride, weights);
    EXPECT_NEAR(search().price, static_cast<double>(least) / 16 * 0.04, 1e-6) << round;
  }
}

/** A forbidden class leaves free what single columns thread, and longer steps may not. */
TEST_F(RelaxedSearch, findsAWayWhereThereIsOneForSingleColumns) {
  constexpr std::int64_t kNoWay = std::int64_t{1} << 40;
  order = {5, {{1}, {2}, {0}}};
  options.vehicle.wheelTrack = 0;
  options.vehicle.footprint = Footprint::rectangle(-0.25, 0.55, 0.6);
  std::mt19937 random(5);
  int ways = 0;
  for (int round = 0; round < 40; ++round) {
    world = PaintedWorld();
    const Patches patches(world, 2 + round % 2, random);
    const int from = patches.anywhere(random, 2), to = patches.anywhere(random, 2);
    start = patches.poseAt(from);
    goal = patches.poseAt(to);
    if (from == to || patches.leastCost(from, to, 1, {1, 1, kNoWay}) >= kNoWay) continue;
    EXPECT_FALSE(guide().empty()) << round;
    ++ways;
  }
  EXPECT_GT(ways, 10);
}

TEST_F(RelaxedSearch, keepsTheFootprintOffWalls) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
  world.box(-1, -0.6, -15, 4, 0, 2, PaintedWorld::Wall);
  world.box(-1, -0.6, 4.6, 9, 0, 2, PaintedWorld::Wall);  // a gap of 0.6 m, and a way around
  world.box(-1, -0.6, 11.4, 15, 0, 2, PaintedWorld::Wall);
  start = {-10, 4.3, 0};
  goal = {10, 4.3, 0};
  const auto path = guide();
  ASSERT_FALSE(path.empty());
  for (const PathPoint& p : path) EXPECT_TRUE(std::abs(p.x + 0.8) > 0.3 || p.y > 9) << p.y;
}
