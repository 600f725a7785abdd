#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <semantic_abstraction/Abstraction.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <random>

#include "PlannerFixture.h"
#include "TemporaryFolder.h"

using namespace semantic_planning;
using semantic_octree::SemanticOcTree;
using semantic_octree::StoredMap;

namespace {

constexpr double kTile = 3.2;  // m, of ground: 16 voxels of 0.2 m

class CorridorTest : public PlannerTest {
 protected:
  Corridor corridor(const SemanticOcTree& of, double width) const {
    return findCorridor(of, order, options, {start, goal, {}, {}, width});
  }
  PlanResult planIn(SemanticOcTree& of, const std::optional<Corridor>& corridor) const {
    if (!hasAbstraction(of)) setAbstraction(of, abstractionFor(order));
    return SemanticPlanner(of, order, options, corridor).plan(start, goal);
  }
  static void expectSame(const PlanResult& a, const PlanResult& b) {
    ASSERT_TRUE(a.found() && b.found()) << a.reason << b.reason;
    EXPECT_EQ(a.cost, b.cost);
    EXPECT_EQ(a.numEdges, b.numEdges);
    ASSERT_EQ(a.path.size(), b.path.size());
    for (std::size_t i = 0; i < a.path.size(); ++i) {
      EXPECT_EQ(a.path[i].x, b.path[i].x);
      EXPECT_EQ(a.path[i].y, b.path[i].y);
      EXPECT_EQ(a.path[i].heading, b.path[i].heading);
    }
  }

  /** A street with a bend, 130 m long, between lawns and walls. */
  void paintStreet() {
    for (double x = -60; x < 60; x += 20) {
      world.floor(x, x + 20, -10, 10, PaintedWorld::Grass);
      world.floor(x, x + 20, x < 0 ? -6 : 2, x < 0 ? -2 : 6, PaintedWorld::Road);
      world.box(x + 5, x + 15, -0.4, 0.2, 0, 2, PaintedWorld::Wall);
      world.map({x + 10, 0.05, 12});
    }
    world.floor(-2, 2, -6, 6, PaintedWorld::Road);
    world.map({0.05, 0.05, 12});
    start = {-57, -4, 0};
    goal = {57, 4, 0};
    options.shorten = true;
  }
};

/** A square of tiles of ground, each of one class or a hole, with all ways over them. */
class TileWorld {
 public:
  static constexpr int kEdge = 9;

  explicit TileWorld(unsigned seed) {
    std::mt19937 random(seed);
    for (int& rank : m_ranks) rank = static_cast<int>(random() % 4) - 1;
    m_ranks.front() = m_ranks.back() = 0;
  }

  void paint(PaintedWorld& world) const {
    constexpr std::array kOfRank = {PaintedWorld::Road, PaintedWorld::Grass, PaintedWorld::Mud};
    for (int x = 0; x < kEdge; ++x)
      for (int y = 0; y < kEdge; ++y)
        if (rank(x, y) >= 0)
          world.floor(x * kTile, (x + 1) * kTile, y * kTile, (y + 1) * kTile,
                      kOfRank[static_cast<std::size_t>(rank(x, y))]);
  }

  static constexpr std::int64_t kNoWay = INT64_MAX;

  /** What a step into a tile from one next to it costs; none leads past the corner of a hole. */
  std::int64_t cost(int x, int y, int toX, int toY) const {
    if (rank(toX, toY) < 0 || rank(x, toY) < 0 || rank(toX, y) < 0) return kNoWay;
    const std::int64_t length = x != toX && y != toY ? 7 : 5;
    return length << (8 * rank(toX, toY));
  }

  /** From the first tile to the last, by Bellman and Ford. */
  std::int64_t leastCost() const {
    std::array<std::int64_t, kEdge * kEdge> least;
    least.fill(kNoWay);
    least[0] = 0;
    for (int round = 0; round < kEdge * kEdge; ++round)
      for (int i = 0; i < kEdge * kEdge; ++i)
        for (int j = 0; j < kEdge * kEdge; ++j) {
          const int x = i % kEdge, y = i / kEdge, toX = j % kEdge, toY = j / kEdge;
          if (i == j || std::abs(x - toX) > 1 || std::abs(y - toY) > 1) continue;
          const std::int64_t step = cost(x, y, toX, toY);
          if (least[i] != kNoWay && step != kNoWay) least[j] = std::min(least[j], least[i] + step);
        }
    return least.back();
  }

  std::int64_t costOf(const Corridor& corridor) const {
    const auto tile = [](double meters) { return static_cast<int>(meters / kTile); };
    std::int64_t sum = 0;
    const auto& way = corridor.way;  // its ends are start and goal
    for (std::size_t i = 2; i + 1 < way.size(); ++i) {
      const std::int64_t step =
          cost(tile(way[i - 1].x), tile(way[i - 1].y), tile(way[i].x), tile(way[i].y));
      EXPECT_NE(step, kNoWay);
      sum += step;
    }
    return way.size() > 2 ? sum : kNoWay;
  }

 private:
  int rank(int x, int y) const { return m_ranks[static_cast<std::size_t>(y * kEdge + x)]; }

  std::array<int, kEdge * kEdge> m_ranks;  ///< negative: a hole
};

}  // namespace

TEST_F(CorridorTest, itsWayIsTheBestOfAllOverTilesOfGround) {
  options.ground.fillGap = options.ground.unknownGap = 0;
  constexpr double kMiddle = kTile / 2, kLast = TileWorld::kEdge * kTile - kMiddle;
  start = {kMiddle, kMiddle, 0};
  goal = {kLast, kLast, 0};
  int found = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const TileWorld tiles(seed);
    PaintedWorld painted;
    tiles.paint(painted);
    const std::int64_t cost = tiles.leastCost();
    EXPECT_EQ(tiles.costOf(corridor(painted.map({kLast / 2, kLast / 2, 30}), 5)), cost) << seed;
    found += cost != TileWorld::kNoWay;
  }
  EXPECT_GT(found, 5);
  EXPECT_LT(found, 20);
}

TEST_F(CorridorTest, itsWayDoesNotLeadThroughGapsThatAreTooNarrow) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Road);
  world.box(-15, -0.6, -0.2, 0.2, 0, 2, PaintedWorld::Wall);
  world.box(0, 10, -0.2, 0.2, 0, 2, PaintedWorld::Wall);  // gaps of 0.6 m and 5 m
  start = {0, -8, 0}, goal = {0, 8, 0};
  const Corridor narrow = corridor(map(), 5);
  double farthest = 0;
  for (const auto& p : narrow.way) farthest = std::max(farthest, p.x);
  EXPECT_GT(farthest, 10);
  EXPECT_TRUE(planIn(map(), narrow).found());
}

TEST_F(CorridorTest, aPlanInOneThatHoldsAllIsThatWithoutOne) {
  paintCorner();
  options.shorten = true;
  options.roadmap.buffer = std::numeric_limits<double>::infinity();
  expectSame(planIn(map(), corridor(map(), 100)), planIn(map(), {}));
}

TEST_F(CorridorTest, aPlanIsTheSameWithTheTilesThatItNeedsUnderATenthOfTheMap) {
  paintStreet();
  SemanticOcTree& whole = world.map();
  const TemporaryFolder folder;
  {
    StoredMap stored(emptyLike(whole), folder / "tiles", {500, 12.8});
    copyTo(stored.tree(), whole);
    stored.folder()->save();
  }
  const double tenth = static_cast<double>(whole.memoryUsage()) / 10e6;
  Corridor found;
  {
    StoredMap stored(folder / "tiles", tenth);
    found = corridor(stored.tree(), 6);
  }
  EXPECT_EQ(found.way, corridor(whole, 6).way);
  StoredMap narrow(folder / "tiles", tenth, [&](const Eigen::AlignedBox3d& cube) {
    return found.mayNeed({cube.min().x(), cube.min().y()}, {cube.max().x(), cube.max().y()});
  });
  const PlanResult plan = planIn(narrow.tree(), found);
  EXPECT_LT(narrow.tree().memoryUsage(), 2e6 * tenth);
  expectSame(plan, planIn(whole, found));
  expectDrivable(plan);
  EXPECT_LE(meters(plan, PaintedWorld::Grass), 1);
}

TEST_F(CorridorTest, whatIsNoGroundIsSaidByThePlan) {
  paintCorner();
  const TPose2D there = start;
  for (const TPose2D& nowhere : {TPose2D(500, 0, 0), TPose2D(-1e6, 1e6, 0)}) {
    start = nowhere;
    EXPECT_EQ(planIn(map(), corridor(map(), 5)).status, PlanStatus::StartOffGround);
    start = there;
    goal = nowhere;
    EXPECT_EQ(planIn(map(), corridor(map(), 5)).status, PlanStatus::GoalOffGround);
  }
  goal.x = std::nan("");
  EXPECT_THROW(corridor(map(), 5), std::invalid_argument);
}

TEST_F(CorridorTest, aDamagedTileIsNamedIfItIsMetAndDoesNotMatterOtherwise) {
  paintStreet();
  const TemporaryFolder folder;
  {
    StoredMap stored(emptyLike(world.map()), folder / "tiles", {500, 12.8});
    copyTo(stored.tree(), world.map());
    stored.folder()->save();
  }
  // From x = 51.2 on, which is beyond a square of ground and its margin from the first half.
  for (const auto& file : std::filesystem::directory_iterator(folder / "tiles"))
    if (file.path().filename().string().rfind("tile_4_", 0) == 0)
      std::ofstream(file.path()) << "damaged";
  StoredMap stored(folder / "tiles", 1);
  try {
    corridor(stored.tree(), 6);
    ADD_FAILURE();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("tile_4_"), std::string::npos) << e.what();
  }
  goal = {-20, -4, 0};
  const Corridor found = corridor(stored.tree(), 6);
  StoredMap narrow(folder / "tiles", 1, [&](const Eigen::AlignedBox3d& cube) {
    return found.mayNeed({cube.min().x(), cube.min().y()}, {cube.max().x(), cube.max().y()});
  });
  EXPECT_TRUE(planIn(narrow.tree(), found).found());
}
