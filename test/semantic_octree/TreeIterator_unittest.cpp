// Iterators, against a walk without them. (OctomapConversion_unittest.cpp holds them against
// OctoMap's.)
#include <gtest/gtest.h>

#include "Voxels.h"

using namespace semantic_octree;

namespace {

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

/** What an iterator says where it stands. */
struct Stop {
  octomap::OcTreeKey key, lowest;
  unsigned depth;
  double size, x, y, z;
  float value;
  bool isLeaf;

  template <typename Iterator>
  Stop(const Iterator& at, bool isNodeLeaf)
      : key(at.getKey()),
        lowest(at.getIndexKey()),
        depth(at.getDepth()),
        size(at.getSize()),
        x(at.getX()),
        y(at.getY()),
        z(at.getZ()),
        value(at->getLogOdds()),
        isLeaf(isNodeLeaf) {}
  Stop(const SemanticOcTreeNode& node, int cubeDepth, const std::array<int, 3>& first)
      : depth(static_cast<unsigned>(cubeDepth)),
        size(kVisitedResolution * edgeAtDepth(cubeDepth)),
        value(node.getLogOdds()),
        isLeaf(node.isLeaf()) {
    const int half = edgeAtDepth(cubeDepth) / 2;
    lowest = octomapKey(first[0], first[1], first[2]);
    key = octomapKey(first[0] + half, first[1] + half, first[2] + half);
    const auto center = [&](int axis) {
      return (first[axis] - kKeyOfOrigin) * kVisitedResolution + size / 2;
    };
    x = center(0), y = center(1), z = center(2);
  }
};

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

std::vector<Stop> stops(TreeIterator begin, const TreeIterator& end) {
  std::vector<Stop> result;
  for (; begin != end; ++begin) result.emplace_back(begin, begin.isLeaf());
  return result;
}

/** What a walk stops at: nodes that meet a box of keys. */
struct Walk {
  int maxDepth;
  bool innerNodes;
  std::array<int, 3> low{0, 0, 0}, high{65535, 65535, 65535};
  std::vector<Stop> stops = {};

  void visit(const SemanticOcTreeNode& node, int depth, const std::array<int, 3>& first) {
    const int edge = edgeAtDepth(depth);
    if (!node) return;
    for (int axis = 0; axis < 3; ++axis)
      if (first[axis] > high[axis] || first[axis] + edge - 1 < low[axis]) return;
    const bool isLast = node.isLeaf() || depth == maxDepth;
    if (isLast || innerNodes) stops.emplace_back(node, depth, first);
    for (int i = 0; i < 8 && !isLast; ++i)
      visit(node.child(i), depth + 1,
            {first[0] + (i & 1) * edge / 2, first[1] + (i >> 1 & 1) * edge / 2,
             first[2] + (i >> 2) * edge / 2});
  }
};

std::vector<Stop> walk(const SemanticOcTree& map, Walk walk) {
  walk.visit(map.root(), 0, {0, 0, 0});
  return walk.stops;
}

}  // namespace

TEST(TreeIterator, visitsWhatAWalkVisitsInItsOrder) {
  for (const bool pruning : {true, false}) {
    const SemanticOcTree map = someMap(pruning);
    for (const int depth : {0, 16, 15, 14, 13, 9, 1}) {
      const int last = depth == 0 ? 16 : depth;
      const auto maxDepth = static_cast<unsigned>(depth);
      expectSameStops(stops(map.begin_leafs(maxDepth), map.end_leafs()), walk(map, {last, false}));
      expectSameStops(stops(map.begin_tree(maxDepth), map.end_tree()), walk(map, {last, true}));
    }
  }
}

TEST(TreeIterator, ofBoxesVisitsWhatAWalkVisits) {
  std::mt19937 random(6);
  const SemanticOcTree map = someMap();
  for (int round = 0; round < 100; ++round) {
    Walk wanted{round % 3 ? 16 : 12 + round % 5, false};
    for (int axis = 0; axis < 3; ++axis) {
      wanted.low[axis] = kKeyOfOrigin + static_cast<int>(between(random, -30, 20));
      wanted.high[axis] = wanted.low[axis] + static_cast<int>(between(random, 0, 20));
    }
    const auto &a = wanted.low, &b = wanted.high;
    const octomap::OcTreeKey low = octomapKey(a[0], a[1], a[2]),
                             high = octomapKey(b[0], b[1], b[2]);
    const auto depth = static_cast<unsigned>(wanted.maxDepth);
    const std::vector<Stop> expected = walk(map, wanted);
    expectSameStops(stops(map.begin_leafs_bbx(low, high, depth), map.end_leafs_bbx()), expected);
    expectSameStops(stops(map.begin_leafs_bbx(map.keyToCoord(low), map.keyToCoord(high), depth),
                          map.end_leafs_bbx()),
                    expected);
  }
  EXPECT_EQ(map.begin_leafs_bbx(octomap::point3d(1e6f, 0, 0), octomap::point3d(1, 1, 1)),
            map.end_leafs_bbx());
}
