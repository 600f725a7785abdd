#include <gtest/gtest.h>
#include <map_view/CellSource.h>
#include <semantic_abstraction/Abstraction.h>

#include <map>
#include <set>

#include "RandomMap.h"

namespace {

using namespace map_view;
using semantic_octree::kNumKeys;
using semantic_octree::kTreeDepth;
using semantic_octree::lowestKeyAtDepth;

const KeyBox kAll = {Eigen::Array3i::Zero(), Eigen::Array3i::Constant(kNumKeys - 1)};

Eigen::Array3i atDepth(const Eigen::Array3i& key, int depth) {
  return key.unaryExpr([depth](int k) { return lowestKeyAtDepth(k, depth); });
}

/** Whether they are occupied. */
std::map<CubeId, bool> shown(const CellSource& cells, const CellLook& look, int maxDepth,
                             const KeyBox& box = kAll) {
  std::map<CubeId, bool> found;
  cells.forEachShown(box, maxDepth, look, [&](const ViewCell& cell) {
    EXPECT_TRUE(found.emplace(cubeOf(cell.lowest, cell.depth), cell.isOccupied()).second);
  });
  return found;
}

/** What finer leaves become at a depth. */
std::map<CubeId, bool> together(const std::map<CubeId, bool>& leaves, int maxDepth) {
  std::map<CubeId, bool> cubes;
  for (const auto& [cube, occupied] : leaves) {
    const auto [x, y, z, depth] = cube;
    const int d = std::min(depth, maxDepth);
    bool& is = cubes[cubeOf(atDepth({x, y, z}, d), d)];
    is = is || occupied;
  }
  return cubes;
}

std::map<CubeId, bool> leavesOf(const SemanticOcTree& map, bool withFree) {
  std::map<CubeId, bool> leaves;
  for (auto it = map.begin_leafs(); it != map.end_leafs(); ++it) {
    const octomap::OcTreeKey key = it.getIndexKey();
    if (withFree || map.isNodeOccupied(*it))
      leaves[cubeOf({key[0], key[1], key[2]}, int(it.getDepth()))] = map.isNodeOccupied(*it);
  }
  return leaves;
}

semantic_octree::AbstractionOptions keepRoads() {
  semantic_octree::AbstractionOptions options;
  options.weights = {{{"road", 1, {{1}}}, {"tree", 0.5, {{2}}}}, 0.01};
  return options;
}

TEST(FullCells, AreTheLeavesAndAtADepthTheCubesAroundThem) {
  const SemanticOcTree map = randomMap(1);
  const CellSource cells(map);
  CellLook look(map);
  for (const bool withFree : {false, true}) {
    ViewStyle style;
    style.freeSpace = withFree;
    look.setStyle(style);
    const auto leaves = leavesOf(map, withFree);
    ASSERT_GT(leaves.size(), 3000u);
    for (const int depth : {kTreeDepth, 14, 11, 9})
      EXPECT_EQ(shown(cells, look, depth), together(leaves, depth)) << depth;
  }
}

TEST(FullCells, AreThoseOfABoxOnly) {
  const SemanticOcTree map = randomMap(2);
  const CellSource cells(map);
  const CellLook look(map);
  const KeyBox box = {Eigen::Array3i(32760, 32750, 32740), Eigen::Array3i(32790, 32800, 32771)};
  std::map<CubeId, bool> expected;
  for (const auto& [cube, occupied] : shown(cells, look, kTreeDepth)) {
    const auto [x, y, z, depth] = cube;
    if (box.meets({{x, y, z}, depth})) expected[cube] = occupied;
  }
  EXPECT_GT(expected.size(), 100u);
  EXPECT_EQ(shown(cells, look, kTreeDepth, box), expected);
}

TEST(FullCells, AnswerForEachVoxelAndForUnknownSpace) {
  const SemanticOcTree map = randomMap(3);
  const CellSource cells(map);
  std::mt19937 random(4);
  int unknown = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto near = [&] { return 32768 + int(random() % 160) - 80; };
    const Eigen::Array3i key(near(), near(), near());
    const ViewCell cell = cells.at(key);
    EXPECT_TRUE((cell.lowest <= key).all() && (cell.lowest + cell.edge() > key).all());
    const auto node = map.search(semantic_octree::octomapKey(key.x(), key.y(), key.z()));
    EXPECT_EQ(cell.node, node);
    unknown += !node;
  }
  EXPECT_GT(unknown, 100);
}

TEST(CompressedCells, AreTheLeavesOfTheCompressedTree) {
  SemanticOcTree map = randomMap(5), other = map;
  const LiveCompression compression(map, keepRoads());
  const CellSource cells(map, &compression);
  setAbstraction(other, keepRoads());
  CellLook look(map);
  for (const bool withFree : {false, true}) {
    ViewStyle style;
    style.freeSpace = withFree;
    look.setStyle(style);
    std::map<CubeId, bool> leaves;
    for (const auto& leaf : semantic_octree::Abstraction(other).leaves())
      if (withFree || other.isNodeOccupied(leaf.node))
        leaves[cubeOf(leaf.lowest, leaf.depth)] = other.isNodeOccupied(leaf.node);
    ASSERT_GT(leaves.size(), 100u);
    ASSERT_LT(leaves.size(), map.getNumLeafNodes());
    for (const int depth : {kTreeDepth, 13, 10})
      EXPECT_EQ(shown(cells, look, depth), together(leaves, depth)) << depth;
    for (const auto& [cube, occupied] : leaves) {
      const auto [x, y, z, depth] = cube;
      EXPECT_EQ(cells.at({x, y, z}).depth, depth);
      EXPECT_EQ(cells.at({x, y, z}).isOccupied(), occupied);
    }
  }
}

KeyBox boxAround(const SemanticOcTree& map) {
  KeyBox box = {Eigen::Array3i::Constant(kNumKeys), Eigen::Array3i::Zero()};
  for (auto it = map.begin_leafs(); it != map.end_leafs(); ++it) {
    const octomap::OcTreeKey key = it.getIndexKey();
    const Eigen::Array3i low(key[0], key[1], key[2]);
    const int edge = semantic_octree::edgeAtDepth(int(it.getDepth()));
    box.low = box.low.min(low), box.high = box.high.max(low + edge - 1);
  }
  return box;
}

template <class F>
void forEachKey(const KeyBox& box, const F& f) {
  for (int z = box.low.z(); z <= box.high.z(); ++z)
    for (int y = box.low.y(); y <= box.high.y(); ++y)
      for (int x = box.low.x(); x <= box.high.x(); ++x) f(Eigen::Array3i(x, y, z));
}

bool isUnknown(const SemanticOcTree& map, const Eigen::Array3i& key) {
  return !map.search(semantic_octree::octomapKey(key.x(), key.y(), key.z()));
}

CellLook withUnknownSpace(const SemanticOcTree& map, const Eigen::AlignedBox3d& clip) {
  ViewStyle style;
  style.unknownSpace = true;
  style.clip = clip;
  CellLook look(map);
  look.setStyle(style);
  return look;
}

}  // namespace

TEST(UnknownSpace, IsWhatNoLeafHoldsWithinTheirBoundingBoxAndTheClippingBox) {
  const SemanticOcTree map = randomMap(15);
  const CellSource cells(map);
  for (const auto& clip :
       {ViewStyle::everywhere(),
        Eigen::AlignedBox3d(Eigen::Vector3d(-8.33, -90, -4.1), Eigen::Vector3d(11.5, 8.71, 3))}) {
    const CellLook look = withUnknownSpace(map, clip);
    std::set<CubeId> voxels, expected;
    std::size_t number = 0;
    cells.forEachShown(kAll, kTreeDepth, look, [&](const ViewCell& cell) {
      if (cell.node) return;
      ++number;
      forEachKey({cell.lowest, cell.lowest + cell.edge() - 1}, [&](const Eigen::Array3i& key) {
        EXPECT_TRUE(voxels.insert(cubeOf(key, kTreeDepth)).second);
      });
    });
    forEachKey(boxAround(map), [&](const Eigen::Array3i& key) {
      const Eigen::Vector3d center = (key.cast<double>() + 0.5 - 32768) * 0.2;
      if (isUnknown(map, key) && clip.contains(center)) expected.insert(cubeOf(key, kTreeDepth));
    });
    ASSERT_GT(expected.size(), 5000u);
    EXPECT_TRUE(voxels == expected) << voxels.size() << ' ' << expected.size();
    EXPECT_LT(number, expected.size() / 2) << "large cubes";
  }
}

TEST(UnknownSpace, IsCoarseWhereAllOfACubeIsUnknown) {
  const SemanticOcTree map = randomMap(16);
  const CellSource cells(map);
  constexpr int kDepth = 13;
  const auto cubes = shown(cells, withUnknownSpace(map, ViewStyle::everywhere()), kDepth),
             occupied = shown(cells, CellLook(map), kDepth);
  const KeyBox box = boxAround(map);
  std::map<CubeId, bool> allUnknown;
  forEachKey(box, [&](const Eigen::Array3i& key) {
    bool& all = allUnknown.emplace(cubeOf(atDepth(key, kDepth), kDepth), true).first->second;
    all = all && isUnknown(map, key);
  });
  int unknown = 0;
  for (const auto& [cube, all] : allUnknown) {
    const auto [x, y, z, depth] = cube;
    if (!box.contains({{x, y, z}, depth})) continue;
    // It may be a part of a larger one.
    int holders = 0;
    for (int d = 0; d <= kDepth; ++d) holders += int(cubes.count(cubeOf(atDepth({x, y, z}, d), d)));
    EXPECT_EQ(holders, int(all || occupied.count(cube) > 0));
    unknown += all;
  }
  EXPECT_GT(unknown, 50);
}

TEST(CellLook, HidesClassesAndWhatIsAbove) {
  const SemanticOcTree map = randomMap(6);
  const CellSource cells(map);
  CellLook look(map);
  ViewStyle style;
  style.hiddenClasses = {false, true, false, false};
  style.clip.max().z() = 1;
  look.setStyle(style);
  std::size_t expected = 0;
  for (auto it = map.begin_leafs(); it != map.end_leafs(); ++it)
    expected += map.isNodeOccupied(*it) && map.query(*it).likeliestClass != 1 && it.getZ() <= 1;
  ASSERT_GT(expected, 500u);
  EXPECT_EQ(shown(cells, look, kTreeDepth).size(), expected);
}

TEST(CellLook, ColorsSayWhatTheyShould) {
  const SemanticOcTree map = randomMap(7);
  CellLook look(map);
  const ViewCell road = CellSource(map).at(voxelOfClass(map, 1));
  ASSERT_EQ(look.classOf(road), 1);
  EXPECT_EQ(look.colorOf(road), map.classes().color(1));
  ViewStyle style;
  for (const ViewColoring coloring : {ViewColoring::Probability, ViewColoring::Entropy,
                                      ViewColoring::Occupancy, ViewColoring::Gain}) {
    style.coloring = coloring;
    look.setStyle(style);
    const Color c = look.colorOf(road);
    EXPECT_GT(c.g, c.b) << int(coloring);  // red, yellow or green
    EXPECT_TRUE(look.scale());
  }
  style.coloring = ViewColoring::Height;
  look.setStyle(style);
  const auto colorAt = [&](int z) {
    return look.colorOf({Eigen::Array3i(32768, 32768, z), kTreeDepth, road.node});
  };
  EXPECT_LT(colorAt(32768 - 10).g, colorAt(32768 + 10).g) << "higher is brighter";
  const auto scale = look.scale();
  ASSERT_TRUE(scale);
  Eigen::Vector3d low, high;
  map.getMetricMin(low.x(), low.y(), low.z());
  map.getMetricMax(high.x(), high.y(), high.z());
  EXPECT_NEAR(std::stod(scale->low), low.z(), 0.05);
  EXPECT_NEAR(std::stod(scale->high), high.z(), 0.05);
  for (const int z : {32768 - 9, 32768, 32768 + 13}) {
    const double height = (z - 32768 + 0.5) * map.getResolution();
    const Color expected = scale->colorAt((height - low.z()) / (high.z() - low.z()));
    EXPECT_EQ(colorAt(z).g, expected.g);
    EXPECT_EQ(colorAt(z).b, expected.b);
  }
  style.clip.max().z() = 0.5;
  look.setStyle(style);
  EXPECT_EQ(look.scale()->high, "0.5");
  style.coloring = ViewColoring::Class;
  look.setStyle(style);
  EXPECT_FALSE(look.scale()) << "the list of classes says it";
}

TEST(CellLook, GainFallsWithEachLook) {
  SemanticOcTree map = randomMap(7);
  map.clear();
  semantic_types::LabeledCloud cloud;
  cloud.points = {{1.01F, 0.01F, 0.01F}};
  cloud.classes = {1};
  ViewStyle style;
  style.coloring = ViewColoring::Gain;
  int before = -1;
  for (int looks = 1; looks < 6; ++looks) {
    map.insert(cloud, Eigen::Isometry3d::Identity());
    CellLook look(map);
    look.setStyle(style);
    const octomap::OcTreeKey key = map.coordToKey(1.01, 0.01, 0.01);
    const Color c = look.colorOf(CellSource(map).at({key[0], key[1], key[2]}));
    const int greenness = c.g - c.r;
    EXPECT_GE(greenness, before) << looks << " looks";
    before = looks == 1 ? greenness + 50 : greenness;
  }
  EXPECT_EQ(before, 215) << "nothing is left to see";
}

TEST(CellAnswer, SaysWhatTheMapSays) {
  SemanticOcTree map = randomMap(8);
  const Eigen::Array3i key = voxelOfClass(map, 1);
  const ViewCell road = CellSource(map).at(key);
  const CellAnswer answer = answerOf(road, map);
  EXPECT_EQ(answer.state, "occupied, road");
  EXPECT_DOUBLE_EQ(answer.size, 0.2);
  EXPECT_EQ(answer.key, semantic_octree::octomapKey(key.x(), key.y(), key.z()));
  EXPECT_NEAR(answer.center.x(), (key.x() - 32768 + 0.5) * 0.2, 1e-9);
  EXPECT_EQ(answer.occupancy, map.query(road.node).occupancy);
  ASSERT_FALSE(answer.shares.empty());
  EXPECT_EQ(answer.shares.front().name, "road");
  double sum = 0;
  for (const auto& share : answer.shares) sum += share.probability;
  EXPECT_NEAR(sum, 1, 0.003);
  EXPECT_EQ(answerOf(CellSource(map).at({100, 100, 100}), map).state, "unknown");
}
