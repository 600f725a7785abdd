// Several readers of one map's changes: each sees what it would see alone.
#include <map_streams/MapStream.h>
#include <map_view/CellSource.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/MapFollower.h>

#include <random>
#include <sstream>

#include "PlannerFixture.h"

using namespace semantic_planning;
using namespace semantic_octree;

namespace {

/** Somebody who follows a map, and what it has to say each time. */
class Reader {
 public:
  virtual ~Reader() = default;
  virtual std::string look() = 0;
};

class PlannerReader : public Reader {
 public:
  PlannerReader(SemanticPlanner planner, mrpt::math::TPose2D start, mrpt::math::TPose2D goal)
      : m_planner(std::move(planner)), m_start(start) {
    m_planner.plan(start, goal);
  }
  std::string look() override {
    const UpdateResult u = m_planner.update();
    const PlanResult plan = m_planner.replan(m_start);
    std::ostringstream text;
    text << u.tilesTouched << ' ' << u.tilesChanged << ' ' << plan.numVertices << ' '
         << plan.numEdges << ' ' << plan.reason << ' ' << plan.length;
    return text.str();
  }

 private:
  SemanticPlanner m_planner;
  mrpt::math::TPose2D m_start;
};

/** Sends the compressed tree, and tells which of its leaves came and went. */
class Publisher : public Reader {
 public:
  explicit Publisher(SemanticOcTree& map) : m_map(map), m_follower(map) {}
  std::string look() override {
    m_sender.setMap(m_map, false);
    std::size_t bytes = 0;
    while (const auto packet = m_sender.next()) {
      bytes += packet->payload.size();
      m_receiver.accept(*packet);
    }
    m_sender.accept(m_receiver.receipt());
    const TreeChange change = m_follower.leaves();
    std::ostringstream text;
    text << bytes << ' ' << change.all << ' ' << change.added.size() << ' ' << change.removed.size()
         << ' ' << (m_receiver.map() == Abstraction(m_map).compressedMap());
    return text.str();
  }

 private:
  SemanticOcTree& m_map;
  LeafFollower m_follower;
  MapSender m_sender{1};
  MapReceiver m_receiver{1};
};

/** Draws tiles anew. */
class Viewer : public Reader {
 public:
  explicit Viewer(SemanticOcTree& map) : m_cells(map), m_follower(map.follow()) {}
  std::string look() override {
    std::size_t drawn = 0;
    const TileChange change = m_follower.tiles();
    for (const octomap::OcTreeKey& k : change.tiles) {
      const Eigen::Array3i low(k[0], k[1], k[2]);
      m_cells.forEachShown({low, low + 7}, 16, m_look, [&](const map_view::ViewCell&) { ++drawn; });
    }
    return std::to_string(change.all) + ' ' + std::to_string(drawn);
  }

 private:
  map_view::CellSource m_cells;
  map_view::CellLook m_look{m_cells.map()};
  MapFollower m_follower;
};

/** Keeps the ground. */
class Field : public Reader {
 public:
  Field(SemanticOcTree& map, const colored_graph::ClassOrder& order)
      : m_follower(map.follow()), m_ground(map, {}, {}, order) {
    m_follower.skipTiles();
  }
  std::string look() override {
    std::ostringstream text;
    for (const Column& tile : m_ground.update(m_follower.tiles())) text << tile.x << ',' << tile.y;
    return text.str();
  }

 private:
  MapFollower m_follower;
  Ground m_ground;
};

constexpr int kKinds = 4;

}  // namespace

TEST_F(PlannerTest, aSecondPlannerOnTheMapDoesNotBlindTheFirst) {
  paintCorner();
  SemanticPlanner p = planner();
  ASSERT_TRUE(p.plan(start, goal).found());
  for (int i = 0; i < 4; ++i) {
    world.box(goal.x - 1, goal.x + 1, goal.y - 1, goal.y + 1, 0, 1, PaintedWorld::Wall).map();
    const SemanticPlanner second = planner();
    EXPECT_NE(second.check(goal), PlanStatus::Found);
    EXPECT_GT(p.update().tilesTouched, 0u);
  }
  const PlanResult after = p.replan(start);
  EXPECT_FALSE(after.found());
  EXPECT_EQ(after.reason, plan().reason);
}

TEST_F(PlannerTest, aPlannerFollowsAMapThatBeginsAnew) {
  paintCorner();
  SemanticPlanner p = planner();
  ASSERT_TRUE(p.plan(start, goal).found());
  map().clear();
  p.update();
  EXPECT_EQ(p.replan(start).status, PlanStatus::StartOffGround);
  paintCorner();
  world.floor(-3, 0, 8.5, 11.5, PaintedWorld::Mud).map();
  p.update();
  const PlanResult anew = p.replan(start);
  expectDrivable(anew);
  EXPECT_EQ(anew.cost, plan().cost);
  EXPECT_EQ(p.plan(start, goal).length, plan().length);
}

class ReadersOfOneMap : public PlannerTest,
                        public testing::WithParamInterface<std::pair<int, int>> {
 protected:
  std::unique_ptr<Reader> reader(int kind) {
    if (kind == 0) return std::make_unique<PlannerReader>(planner(), start, goal);
    if (kind == 1) return std::make_unique<Publisher>(map());
    if (kind == 2) return std::make_unique<Viewer>(map());
    return std::make_unique<Field>(map(), order);
  }

  /** What readers say of a world that changes, each at times of its own. */
  std::vector<std::string> saidBy(const std::vector<int>& kinds) {
    world = PaintedWorld();
    paintCorner();
    options.roadmap.vertices = 150;
    std::vector<std::unique_ptr<Reader>> readers(kKinds);
    for (const int kind : kinds) readers[kind] = reader(kind);
    std::vector<std::string> said(kKinds);
    std::mt19937 random(5);
    for (int round = 0; round < 8; ++round) {
      const double x = double(random() % 200) / 10 - 10, y = double(random() % 200) / 10 - 10;
      const auto id = round % 2 ? PaintedWorld::Wall : PaintedWorld::Mud;
      world.box(x, x + 2, y, y + 2, -0.2, 0.5 * (round % 2), id).map();
      const unsigned looks = random();
      for (const int kind : kinds)
        if (looks >> kind & 1) said[kind] += readers[kind]->look() + '\n';
    }
    return said;
  }
};

TEST_P(ReadersOfOneMap, sayWhatEachSaysAlone) {
  const auto [a, b] = GetParam();
  const auto both = saidBy({a, b});
  EXPECT_EQ(both[a], saidBy({a})[a]);
  EXPECT_EQ(both[b], saidBy({b})[b]);
  EXPECT_EQ(both, saidBy({b, a}));
  EXPECT_FALSE(both[a].empty() || both[b].empty());
}

INSTANTIATE_TEST_SUITE_P(Pairs, ReadersOfOneMap,
                         testing::Values(std::pair(0, 1), std::pair(0, 2), std::pair(0, 3),
                                         std::pair(1, 2), std::pair(1, 3), std::pair(2, 3)));

static void insertPoint(SemanticOcTree& map) {
  semantic_types::LabeledCloud cloud;
  cloud.points = {{1, 1, 1}};
  map.insert(cloud, Eigen::Isometry3d::Identity());
}

TEST_F(PlannerTest, whoChangesTheMapWhileItIsReadIsRefusedAndNothingIsLost) {
  paintCorner();
  SemanticOcTree& m = map();
  const SemanticOcTree before = m;
  int asked = 0, refused = 0;
  options.cancelled = [&] {
    ++asked;
    try {
      insertPoint(m);
    } catch (const std::logic_error&) {
      ++refused;
    }
    return false;
  };
  expectDrivable(plan());
  EXPECT_GT(asked, 0);
  EXPECT_EQ(refused, asked);
  EXPECT_TRUE(m == before);
  insertPoint(m);
  EXPECT_FALSE(m == before);
}

TEST(ReadLock, HoldsWhileItLivesAgainstEachChange) {
  PaintedWorld world;
  world.floor(-1, 1, -1, 1, PaintedWorld::Road);
  SemanticOcTree& m = world.map();
  const SemanticOcTree before = m;
  {
    const ReadLock one(m), two(m);
    EXPECT_THROW(insertPoint(m), std::logic_error);
    EXPECT_THROW(m.clear(), std::logic_error);
    EXPECT_TRUE(m == before);
  }
  m.clear();
  EXPECT_TRUE(m.empty());
}
