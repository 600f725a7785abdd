#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <numeric>

#include "PlainMap.h"
#include "RandomScans.h"
#include "Voxels.h"

using namespace semantic_octree;

namespace {

constexpr double kQueryResolution = 0.25;
constexpr int kQueryClasses = 5;

InsertionOptions insertion() {
  InsertionOptions options;
  options.maxRange = 6;
  return options;
}

/** A tree and a plain map receive equal scans. */
struct TwoMaps {
  SemanticOcTree tree{kQueryResolution, numberedClasses(kQueryClasses)};
  PlainMap plain{kQueryResolution, kQueryClasses};

  explicit TwoMaps(unsigned seed) {
    std::mt19937 random(seed);
    for (int place = 0; place < 3; ++place) {
      const PosedCloud scan = randomScan(random);
      for (int repeat = 0; repeat < 4; ++repeat) {
        tree.insert(scan.cloud, scan.T_map_sensor, insertion());
        plain.insert(scan, insertion());
      }
    }
  }
};

const TwoMaps& maps() {
  static const TwoMaps maps(1);
  return maps;
}

octomap::point3d randomPoint(std::mt19937& random, double spread) {
  const auto coordinate = [&] { return static_cast<float>(between(random, -spread, spread)); };
  const float x = coordinate(), y = coordinate(), z = coordinate();
  return {x, y, z};
}

/** First occupied voxel of the plain map along a ray, by all border crossings in order. */
std::optional<VoxelId> castPlainRay(const PlainMap& map, const octomap::point3d& origin,
                                    const octomap::point3d& direction, double maxRange,
                                    bool ignoreUnknown) {
  const octomap::point3d unit = direction.normalized();
  std::vector<std::pair<double, int>> crossings;
  VoxelId v;
  for (int axis = 0; axis < 3; ++axis) {
    const double begin = origin(axis) / map.resolution(), slope = unit(axis) / map.resolution();
    v[axis] = static_cast<int>(std::floor(begin));
    for (int n = 0; n < 100 && slope != 0; ++n)
      crossings.emplace_back(((slope > 0 ? v[axis] + 1 + n : v[axis] - n) - begin) / slope, axis);
  }
  std::sort(crossings.begin(), crossings.end());
  std::size_t next = 0;
  do {
    double squaredDistance = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double center = (v[axis] + 0.5) * map.resolution();
      squaredDistance += (center - origin(axis)) * (center - origin(axis));
    }
    if (next > 0 && maxRange > 0 && squaredDistance > maxRange * maxRange) return std::nullopt;
    const auto found = map.voxels().find(v);
    if (found != map.voxels().end() && found->second.value > 0) return v;
    if (found == map.voxels().end() && !ignoreUnknown) return std::nullopt;
    const int axis = crossings[next].second;
    v[axis] += unit(axis) > 0 ? 1 : -1;
  } while (++next < 200);
  return std::nullopt;
}

TEST(Queries, tellTheStateOfEveryVoxel) {
  const auto& [tree, plain] = maps();
  for (const auto& [id, voxel] : plain.voxels()) {
    const CellState state = tree.query(keyOf(id));
    EXPECT_NEAR(state.occupancy, 1 / (1 + std::exp(-voxel.value)), 1e-6);
    EXPECT_EQ(state.status,
              voxel.value > 0 ? CellState::Status::Occupied : CellState::Status::Free);
    if (!voxel.record) {
      EXPECT_EQ(state.likeliestClass, kNoClass);
      continue;
    }
    std::vector<double> p(kQueryClasses + 1);
    voxel.record->distribution(kQueryClasses, p.data());
    const auto best = std::max_element(p.begin() + 1, p.end());
    EXPECT_EQ(state.likeliestClass, best - p.begin());
    EXPECT_EQ(state.probability, *best);
  }
}

TEST(Queries, ofPlacesWithoutANodeSayUnknown) {
  const SemanticOcTree& tree = maps().tree;
  for (const double x : {100.0, -8000.0, 1e9, -1e30, HUGE_VAL, std::nan("")}) {
    const CellState state = tree.query(x, 0, 0);
    EXPECT_EQ(state.status, CellState::Status::Unknown) << x;
    EXPECT_EQ(state.occupancy, 0.5);
    EXPECT_EQ(state.likeliestClass, kNoClass);
    EXPECT_EQ(tree.classes().name(state.likeliestClass), "no class");
  }
  const SemanticOcTree empty(0.1, numberedClasses(2));
  EXPECT_EQ(empty.query(0, 0, 0).status, CellState::Status::Unknown);
  EXPECT_EQ(empty.root(), nullptr);
  EXPECT_EQ(empty.begin_leafs(), empty.end_leafs());
  EXPECT_FALSE(empty.castRay({0, 0, 0}, {1, 0, 0}));
}

TEST(Queries, ofAnInnerNodeMixItsKnownLeavesByVolumeAndTakeTheHighestOccupancy) {
  const auto& [tree, plain] = maps();
  for (const unsigned depth : {15u, 14u, 12u}) {
    struct Cell {
      float highest = -HUGE_VALF;  ///< log-odds
      std::vector<double> sum{std::vector<double>(kQueryClasses + 1)}, labeled = sum;
    };
    std::map<VoxelId, Cell> cells;
    const int shift = static_cast<int>(16 - depth);
    for (const auto& [id, voxel] : plain.voxels()) {
      Cell& cell = cells[{id[0] >> shift, id[1] >> shift, id[2] >> shift}];
      const auto p = tree.distribution(*tree.search(keyOf(id)));
      for (int k = 0; k <= kQueryClasses; ++k) cell.sum[k] += p[k];
      for (int k = 1; voxel.record && k <= kQueryClasses; ++k) cell.labeled[k] += p[k];
      cell.highest = std::max(cell.highest, voxel.value);
    }
    for (const auto& [id, cell] : cells) {
      const auto node = tree.search(
          keyOf({id[0] * (1 << shift), id[1] * (1 << shift), id[2] * (1 << shift)}), depth);
      ASSERT_NE(node, nullptr);
      EXPECT_EQ(node->getLogOdds(), cell.highest);
      const std::vector<double> p = tree.distribution(*node);
      const double total = std::accumulate(cell.sum.begin(), cell.sum.end(), 0.0),
                   all = std::accumulate(cell.labeled.begin(), cell.labeled.end(), 0.0);
      for (int k = 0; k <= kQueryClasses; ++k) EXPECT_NEAR(p[k], cell.sum[k] / total, 1e-9);
      const CellState state = tree.query(*node);
      EXPECT_EQ(state.likeliestClass != kNoClass, all > 0);
      if (all == 0) continue;
      const double most = *std::max_element(cell.labeled.begin(), cell.labeled.end());
      EXPECT_NEAR(cell.labeled[state.likeliestClass], most, 1e-9);
      if (node->isLeaf()) continue;
      EXPECT_NEAR(state.probability, state.occupancy * most / all, 1e-9);
    }
  }
}

TEST(Queries, ofAnInnerNodeCountClassesOfLargeLeavesByTheirVolume) {
  SemanticOcTree tree(1.0, numberedClasses(2));
  LabeledCloud cloud;
  for (int i = 0; i < 8; ++i) cloud.points.emplace_back(i % 2 + .5f, i / 2 % 2 + .5f, i / 4 + .5f);
  cloud.points.emplace_back(2.5f, 0.5f, 0.5f);
  cloud.classes = {1, 1, 1, 1, 1, 1, 1, 1, 2};
  InsertionOptions noRays;
  noRays.carvingMargin = 1e3;
  tree.insert(cloud, Eigen::Isometry3d::Identity(), noRays);
  ASSERT_EQ(tree.getNumLeafNodes(), 2u);
  const auto large = tree.distribution(tree.search(keyOf({0, 0, 0}))),
             single = tree.distribution(tree.search(keyOf({2, 0, 0})));
  const double one = 8 * large[1] + single[1], two = 8 * large[2] + single[2];
  const CellState state = tree.query(keyOf({0, 0, 0}), 14);
  EXPECT_EQ(state.likeliestClass, 1);
  EXPECT_NEAR(state.probability, state.occupancy * one / (one + two), 1e-9);
}

TEST(Queries, rayCastsFindTheFirstOccupiedVoxel) {
  const auto& [tree, plain] = maps();
  std::mt19937 random(5);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const octomap::point3d origin = randomPoint(random, 5), direction = randomPoint(random, 1);
    const double maxRange = i % 3 == 0 ? 0 : between(random, 0.5, 6);
    const bool ignoreUnknown = i % 2;
    const auto expected = castPlainRay(plain, origin, direction, maxRange, ignoreUnknown);
    const auto hit = tree.castRay(origin, direction, maxRange, ignoreUnknown);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << "ray " << i;
    if (!hit) continue;
    ++hits;
    EXPECT_EQ(hit->key, keyOf(*expected)) << "ray " << i;
    EXPECT_EQ(hit->state.status, CellState::Status::Occupied);
    EXPECT_LT(hit->center.distance(tree.keyToCoord(hit->key)), 1e-6);
  }
  EXPECT_GT(hits, 150);
}

TEST(Queries, rayCastsFromOutsideOrToTheBorderFindNothingAndPrintNothing) {
  const SemanticOcTree& tree = maps().tree;
  testing::internal::CaptureStderr();
  EXPECT_FALSE(tree.castRay({1e6f, 0, 0}, {-1, 0, 0}));
  EXPECT_FALSE(tree.castRay({NAN, 0, 0}, {-1, 0, 0}));
  EXPECT_FALSE(tree.castRay({0, 0, 100}, {0, 0, 1}));
  EXPECT_FALSE(tree.castRay({8190, 8190, -8190}, {1, 1, -1}));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_THROW(tree.castRay({0, 0, 0}, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(tree.castRay({0, 0, 0}, {NAN, 0, 1}), std::invalid_argument);
}

TEST(Queries, callAVoxelOfEvenOddsFree) {
  FilterParameters even;  // a hit and a miss cancel out
  even.hitProbability = 0.75;
  even.falseAlarmProbability = 0.25;
  SemanticOcTree tree(1.0, numberedClasses(1), even);
  LabeledCloud hit, miss;
  hit.points = {{2.5f, 0.5f, 0.5f}};
  miss.points = {{5.5f, 0.5f, 0.5f}};
  tree.insert(hit, Eigen::Isometry3d::Identity());
  tree.insert(miss, Eigen::Isometry3d::Identity());
  const auto node = tree.search(tree.coordToKey(2.5, 0.5, 0.5));
  EXPECT_EQ(node->getLogOdds(), 0);
  EXPECT_FALSE(tree.isNodeOccupied(node));
  EXPECT_EQ(tree.query(*node).status, CellState::Status::Free);
  EXPECT_EQ(tree.castRay({0.5f, 0.5f, 0.5f}, {1, 0, 0})->key, tree.coordToKey(5.5, 0.5, 0.5));
}

// Extent of a map, and the voxels along a line.

constexpr double kPlaceResolution = 0.3;

template <typename Map>
std::vector<octomap::OcTreeKey> keysAlong(const Map& map, const octomap::point3d& a,
                                          const octomap::point3d& b) {
  octomap::KeyRay ray;
  EXPECT_TRUE(map.computeRayKeys(a, b, ray));
  return {ray.begin(), ray.end()};
}

}  // namespace

TEST(Geometry, voxelsAlongALineAreThoseOfOctomap) {
  std::mt19937 random(1);
  const SemanticOcTree map(kPlaceResolution, numberedClasses(1));
  const octomap::OcTree octree(kPlaceResolution);
  for (int i = 0; i < 2000; ++i) {
    const octomap::point3d a = randomPoint(random, 3), b = randomPoint(random, 3);
    ASSERT_EQ(keysAlong(map, a, b), keysAlong(octree, a, b)) << "line " << i;
  }
}

TEST(Geometry, voxelsAlongALineThroughEdgesAreConnectedAndEndBeforeTheLast) {
  std::mt19937 random(2);
  const SemanticOcTree map(0.25, numberedClasses(1));
  for (int i = 0; i < 5000; ++i) {  // corners and middles of voxels
    const auto point = [&] {
      const auto coordinate = [&] { return 0.125f * static_cast<float>(random() % 30) - 2; };
      const float x = coordinate(), y = coordinate(), z = coordinate();
      return octomap::point3d(x, y, z);
    };
    const octomap::point3d a = point(), b = point();
    std::vector<octomap::OcTreeKey> keys = keysAlong(map, a, b);
    const octomap::OcTreeKey first = map.coordToKey(a), last = map.coordToKey(b);
    if (first == last) {
      EXPECT_TRUE(keys.empty());
      continue;
    }
    ASSERT_FALSE(keys.empty());
    EXPECT_EQ(keys.front(), first);
    for (std::size_t k = 1; k < keys.size(); ++k) {
      int steps = 0;
      for (unsigned axis = 0; axis < 3; ++axis)
        steps += std::abs(keys[k][axis] - keys[k - 1][axis]);
      ASSERT_EQ(steps, 1);
    }
    EXPECT_EQ(std::count(keys.begin(), keys.end(), last), 0);
  }
}

TEST(Geometry, linesThatLeaveTheMapHaveNoVoxels) {
  const SemanticOcTree map(kPlaceResolution, numberedClasses(1));
  octomap::KeyRay ray;
  for (const float outside : {1e5f, -1e5f, NAN, HUGE_VALF}) {
    EXPECT_FALSE(map.computeRayKeys({0, 0, 0}, {0, outside, 0}, ray));
    EXPECT_FALSE(map.computeRayKeys({outside, 0, 0}, {0, 0, 0}, ray));
    EXPECT_EQ(ray.size(), 0u);
  }
}

TEST(Geometry, extentIsTheBoxAroundAllLeaves) {
  std::mt19937 random(3);
  SemanticOcTree map(kPlaceResolution, numberedClasses(5));
  Eigen::Vector3d low, high;
  const auto expectExtent = [&](const Eigen::AlignedBox3d& box) {
    map.getMetricMin(low.x(), low.y(), low.z());
    map.getMetricMax(high.x(), high.y(), high.z());
    EXPECT_LT((low - box.min()).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((high - box.max()).cwiseAbs().maxCoeff(), 1e-9);
  };
  expectExtent({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  for (int i = 0; i < 6; ++i) {
    PosedCloud scan = randomScan(random);
    scan.T_map_sensor.translation() *= 4;
    map.insert(scan.cloud, scan.T_map_sensor);
    Eigen::AlignedBox3d box;
    for (const auto& voxel : voxelsOf(map)) {
      const Eigen::Vector3d center = centerOf(voxel.first, kPlaceResolution);
      box.extend(center - Eigen::Vector3d::Constant(kPlaceResolution / 2));
      box.extend(center + Eigen::Vector3d::Constant(kPlaceResolution / 2));
    }
    expectExtent(box);
  }
}
