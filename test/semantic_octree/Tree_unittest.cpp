#include <gtest/gtest.h>
#include <map_operations/MapOperations.h>
#include <octomap/OcTree.h>
#include <rapidcheck.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/Keys.h>

#include <algorithm>
#include <cstdlib>

#include "PlainMap.h"
#include "RandomScans.h"
#include "SmallScans.h"
#include "Voxels.h"

using namespace semantic_octree;

namespace {

SemanticOcTree treeOfScans(unsigned seed, double resolution = 0.3, int classes = 5) {
  std::mt19937 random(seed);
  SemanticOcTree tree(resolution, numberedClasses(classes));
  for (int i = 0; i < 3; ++i) {
    const PosedCloud scan = randomScan(random);
    tree.insert(scan.cloud, scan.T_map_sensor);
  }
  return tree;
}

void insertOne(SemanticOcTree& tree, unsigned seed, const InsertionOptions& options = {}) {
  std::mt19937 random(seed);
  const PosedCloud scan = randomScan(random);
  tree.insert(scan.cloud, scan.T_map_sensor, options);
}

TEST(Tree, copiesShareNothing) {
  SemanticOcTree original = treeOfScans(1);
  const SemanticOcTree copy = original, second = original;
  EXPECT_TRUE(copy == original);
  insertOne(original, 2);
  EXPECT_FALSE(copy == original);
  EXPECT_TRUE(copy == second);
  original.clear();
  EXPECT_TRUE(copy == second);
}

TEST(Tree, keepsItsNodesWhereBookkeepingComesAndGoes) {
  SemanticOcTree plain = treeOfScans(18), tree = plain;
  AbstractionOptions options;
  for (unsigned seed = 20; seed < 24; ++seed) {
    options.weights.terms.push_back(tree_abstraction::relevant(std::to_string(seed), 1, {1}));
    setAbstraction(tree, options);
    EXPECT_TRUE(tree == plain);
    SemanticOcTree copy = tree;
    for (SemanticOcTree* map : {&plain, &tree, &copy}) insertOne(*map, seed);
    EXPECT_TRUE(copy == tree);
    EXPECT_TRUE(tree == plain);
    if (seed % 2) dropAbstraction(tree);
    insertOne(copy, seed + 10);
    EXPECT_FALSE(copy == tree);
    EXPECT_TRUE(tree == plain);
    EXPECT_EQ(tree.size(), plain.size());
  }
}

TEST(Tree, assignmentReplacesEverything) {
  const SemanticOcTree a = treeOfScans(4, 0.3);
  SemanticOcTree b = treeOfScans(5, 0.5, 9);
  b = a;
  EXPECT_TRUE(a == b);
  EXPECT_EQ(b.getResolution(), 0.3);
  EXPECT_EQ(b.numClasses(), 5);
  const SemanticOcTree& self = b;
  b = self;
  EXPECT_TRUE(a == b);
}

TEST(Tree, movingLeavesAnEmptyMapOfTheSameKindBehind) {
  SemanticOcTree original = treeOfScans(6);
  const SemanticOcTree copy = original;
  const SemanticOcTree moved = std::move(original);
  EXPECT_TRUE(moved == copy);
  EXPECT_TRUE(original.empty());
  EXPECT_EQ(original.getResolution(), 0.3);
  insertOne(original, 7);
  SemanticOcTree fresh(0.3, numberedClasses(5));
  insertOne(fresh, 7);
  EXPECT_TRUE(original == fresh);
}

TEST(Tree, swappingExchangesEverything) {
  SemanticOcTree a = treeOfScans(8, 0.3), b = treeOfScans(9, 0.5, 9);
  const SemanticOcTree copyOfA = a, copyOfB = b;
  a.swap(b);
  EXPECT_TRUE(a == copyOfB);
  EXPECT_TRUE(b == copyOfA);
  EXPECT_EQ(a.coordToKey(10, 0, 0)[0], octomap::key_type(kKeyOfOrigin + 20));
  insertOne(a, 10);
  SemanticOcTree expected = copyOfB;
  insertOne(expected, 10);
  EXPECT_TRUE(a == expected);
}

TEST(Tree, differsFromAnotherInEachPart) {
  const SemanticOcTree tree = treeOfScans(13);
  EXPECT_FALSE(tree == treeOfScans(14));
  EXPECT_FALSE(tree == treeOfScans(13, 0.31));
  EXPECT_FALSE(SemanticOcTree(0.1, numberedClasses(5)) == SemanticOcTree(0.1, numberedClasses(6)));
  FilterParameters other;
  other.accuracy = 0.8;
  EXPECT_FALSE(SemanticOcTree(0.1, numberedClasses(5)) ==
               SemanticOcTree(0.1, numberedClasses(5), other));
  SemanticOcTree unpruned(0.1, numberedClasses(5));
  unpruned.setPruning(false);
  EXPECT_FALSE(SemanticOcTree(0.1, numberedClasses(5)) == unpruned);
}

TEST(Tree, pruningIsChosenWhileTheTreeIsEmpty) {
  SemanticOcTree tree = treeOfScans(16);
  EXPECT_TRUE(tree.pruning());
  EXPECT_THROW(tree.setPruning(false), std::logic_error);
  tree.clear();
  tree.setPruning(false);
  EXPECT_FALSE(tree.pruning());
  insertOne(tree, 17);
  EXPECT_FALSE(SemanticOcTree(tree).pruning());
}

/** RapidCheck draws the same cases in every run. */
const int kSeedIsFixed = setenv("RC_PARAMS", "seed=20240517", 0);

constexpr double kVoxel = 0.25;  // m; all borders are floats, OctoMap's own precision

/** Keys from one end of the map to the other. */
rc::Gen<int> anyKey() { return rc::gen::inRange(0, kNumKeys); }
rc::Gen<int> anyDepth() { return rc::gen::inRange(0, kTreeDepth + 1); }

constexpr double kVoxelSizes[] = {0.05, 0.07, 0.1, 0.15, 0.2, 0.25, 0.3, 1.0 / 3, 0.35, 0.4};

/** Calls f(coordinate) for voxels' borders (meters), as products and as decimals, and
 * what lies next to them. */
template <typename F>
void forCoordinatesAtBorders(double voxel, int numKeys, const F& f) {
  for (int key = -numKeys; key <= numKeys; ++key)
    for (const double border : {key * voxel, key / 20.0})
      for (const double x :
           {std::nextafter(border, -HUGE_VAL), border, std::nextafter(border, HUGE_VAL)})
        f(x);
}

/** Key of the voxel in which the only return of a scan ends, along x. */
int keyOfReturn(double voxelSize, double sensor, float point) {
  PosedCloud scan;
  scan.T_map_sensor.translation().x() = sensor;
  scan.cloud.points.emplace_back(point, 0, 0);
  SemanticOcTree map(voxelSize, numberedClasses(1));
  map.insert(scan.cloud, scan.T_map_sensor);
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf)
    if (map.isNodeOccupied(*leaf)) return leaf.getKey()[0];
  return -1;
}

TEST(Keys, areThoseOfOctoMap) {
  EXPECT_TRUE(rc::check([] {
    const octomap::OcTree map(kVoxel);
    const int key = *anyKey(), depth = *anyDepth();
    const auto octomaps = static_cast<octomap::key_type>(key);
    RC_ASSERT(centerOf(key, kVoxel) == map.keyToCoord(octomaps));
    RC_ASSERT(keyOf(centerOf(key, kVoxel), kVoxel) == key);
    RC_ASSERT(map.coordToKey(lowerBorderOf(key, kVoxel)) == octomaps);
    if (depth > 0)  // OctoMap says 0 for the root, which is right, in another way
      RC_ASSERT(centerOf(key, kVoxel, depth) == map.keyToCoord(octomaps, unsigned(depth)));
    RC_ASSERT(octomapKey(key, 0, 65535) == octomap::OcTreeKey(octomaps, 0, 65535));
  }));
}

TEST(Keys, aCubeHoldsTheVoxelsFromItsLowestKeyOn) {
  EXPECT_TRUE(rc::check([] {
    const int key = *anyKey(), depth = *anyDepth();
    const int lowest = lowestKeyAtDepth(key, depth), edge = edgeAtDepth(depth);
    RC_ASSERT(lowest % edge == 0);
    RC_ASSERT(lowest <= key && key < lowest + edge);
    const double border = lowerBorderOf(lowest, kVoxel);
    RC_ASSERT(centerOf(key, kVoxel, depth) == border + edge * kVoxel / 2);
  }));
}

TEST(Keys, ofAnyCoordinateAreTheSameByEveryWay) {
  for (const double voxel : kVoxelSizes) {
    const SemanticOcTree map(voxel, numberedClasses(1));
    const octomap::OcTree octomaps(voxel);
    forCoordinatesAtBorders(voxel, 1000, [&](double x) {
      const int key = keyOf(x, voxel);
      ASSERT_EQ(octomaps.coordToKey(x), key) << x << " at " << voxel;
      ASSERT_EQ(map.coordToKey(x, x, x), octomapKey(key, key, key)) << x << " at " << voxel;
      octomap::OcTreeKey checked;
      ASSERT_TRUE(map.coordToKeyChecked(x, x, x, checked));
      ASSERT_EQ(checked, octomapKey(key, key, key)) << x << " at " << voxel;
      const auto single = static_cast<float>(x);
      const octomap::point3d point(single, single, single);
      ASSERT_EQ(map.coordToKey(point)[2], keyOf(single, voxel)) << x << " at " << voxel;
      ASSERT_TRUE(map.coordToKeyChecked(point, checked) && checked == map.coordToKey(point));
    });
  }
}

TEST(Keys, ofAnyCoordinateAreThoseThatScansFind) {
  for (const double voxel : kVoxelSizes)
    forCoordinatesAtBorders(voxel, 60, [&](double x) {
      const auto single = static_cast<float>(x);
      ASSERT_EQ(keyOfReturn(voxel, 0, single), keyOf(single, voxel)) << single << " at " << voxel;
      ASSERT_EQ(keyOfReturn(voxel, x, 0), keyOf(x, voxel)) << x << " at " << voxel;
    });
}

// Iterators, against those of OctoMap. (OctomapConversion_unittest.cpp has the nodes of both.)

constexpr double kVisitedResolution = 0.4;

SemanticOcTree someMap(bool pruning = true) {
  std::mt19937 random(5);
  SemanticOcTree map(kVisitedResolution, numberedClasses(5));
  map.setPruning(pruning);
  for (int i = 0; i < 3; ++i) {
    const PosedCloud scan = randomScan(random);
    for (int repeat = 0; repeat < 6; ++repeat) map.insert(scan.cloud, scan.T_map_sensor);
  }
  return map;
}

bool isLeafAt(const TreeIterator& at, const SemanticOcTree&) { return at.isLeaf(); }
template <class Iterator>
bool isLeafAt(const Iterator& at, const octomap::OcTree& tree) {
  return !tree.nodeHasChildren(&*at);
}

/** What an iterator says where it stands. */
struct Stop {
  octomap::OcTreeKey key, lowest;
  unsigned depth;
  double size, x, y, z;
  float value;
  bool isLeaf;
};

template <class Tree, class Iterator>
std::vector<Stop> stops(const Tree& tree, Iterator at, const Iterator& end) {
  std::vector<Stop> result;
  for (; at != end; ++at)
    result.push_back({at.getKey(), at.getIndexKey(), at.getDepth(), at.getSize(), at.getX(),
                      at.getY(), at.getZ(), at->getLogOdds(), isLeafAt(at, tree)});
  return result;
}

/** The stops whose cubes meet a box of keys. (OctoMap's own also visits some that touch it.) */
std::vector<Stop> meeting(std::vector<Stop> stops, const octomap::OcTreeKey& low,
                          const octomap::OcTreeKey& high) {
  const auto isApart = [&](const Stop& stop) {
    const int edge = edgeAtDepth(static_cast<int>(stop.depth));
    for (unsigned axis = 0; axis < 3; ++axis)
      if (stop.lowest[axis] > high[axis] || stop.lowest[axis] + edge - 1 < low[axis]) return true;
    return false;
  };
  stops.erase(std::remove_if(stops.begin(), stops.end(), isApart), stops.end());
  return stops;
}

void expectSameStops(const std::vector<Stop>& a, const std::vector<Stop>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].key, b[i].key) << "stop " << i;
    EXPECT_EQ(a[i].lowest, b[i].lowest);
    EXPECT_EQ(a[i].depth, b[i].depth);
    EXPECT_EQ(a[i].value, b[i].value);
    EXPECT_EQ(a[i].isLeaf, b[i].isLeaf);
    EXPECT_DOUBLE_EQ(a[i].size, b[i].size);
    EXPECT_NEAR(a[i].x, b[i].x, 1e-9);
    EXPECT_NEAR(a[i].y, b[i].y, 1e-9);
    EXPECT_NEAR(a[i].z, b[i].z, 1e-9);
  }
}

}  // namespace

TEST(TreeIterator, visitsWhatOctomapsDoInTheirOrder) {
  for (const bool pruning : {true, false}) {
    const SemanticOcTree map = someMap(pruning);
    const auto octree = toOcTree(map);
    for (const unsigned char depth : {0, 16, 15, 14, 13, 9, 1}) {
      expectSameStops(stops(map, map.begin_leafs(depth), map.end_leafs()),
                      stops(*octree, octree->begin_leafs(depth), octree->end_leafs()));
      expectSameStops(stops(map, map.begin_tree(depth), map.end_tree()),
                      stops(*octree, octree->begin_tree(depth), octree->end_tree()));
    }
  }
}

TEST(TreeIterator, ofBoxesVisitsOfOctomapsLeavesThoseThatMeetThem) {
  std::mt19937 random(6);
  const SemanticOcTree map = someMap();
  const auto octree = toOcTree(map);
  for (int round = 0; round < 100; ++round) {
    octomap::OcTreeKey low, high;
    for (unsigned axis = 0; axis < 3; ++axis) {
      low[axis] = octomap::key_type(kKeyOfOrigin + between(random, -30, 20));
      high[axis] = octomap::key_type(low[axis] + between(random, 0, 20));
    }
    const auto depth = static_cast<unsigned char>(round % 3 ? 16 : 12 + round % 5);
    const auto expected =
        meeting(stops(*octree, octree->begin_leafs(depth), octree->end_leafs()), low, high);
    expectSameStops(stops(map, map.begin_leafs_bbx(low, high, depth), map.end_leafs_bbx()),
                    expected);
    expectSameStops(
        stops(map, map.begin_leafs_bbx(map.keyToCoord(low), map.keyToCoord(high), depth),
              map.end_leafs_bbx()),
        expected);
  }
  EXPECT_EQ(map.begin_leafs_bbx(octomap::point3d(1e6f, 0, 0), octomap::point3d(1, 1, 1)),
            map.end_leafs_bbx());
}
