// Extent of a map, and the voxels along a line.
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <algorithm>

#include "Voxels.h"

using namespace semantic_octree;

namespace {

constexpr double kPlaceResolution = 0.3;

Eigen::Array3d voxelsOfPoint(const octomap::point3d& p) {
  return Eigen::Array3d(p.x(), p.y(), p.z()) / kPlaceResolution;
}

octomap::point3d randomPoint(std::mt19937& random, double spread) {
  const auto coordinate = [&] { return static_cast<float>(between(random, -spread, spread)); };
  const float x = coordinate(), y = coordinate(), z = coordinate();
  return {x, y, z};
}

/** A line, in voxels. */
struct Line {
  Eigen::Array3d begin, end;

  /** Length of the part, in shares of the line, that is in a voxel grown by a margin. */
  double shareIn(const Eigen::Array3i& voxel, double margin = 0) const {
    double from = 0, to = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = end[axis] - begin[axis];
      const double a = (voxel[axis] - margin - begin[axis]) / d,
                   b = (voxel[axis] + 1 + margin - begin[axis]) / d;
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    return to - from;
  }
  double enters(const Eigen::Array3i& voxel) const {
    double from = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = end[axis] - begin[axis];
      from = std::max(from, (voxel[axis] + (d < 0) - begin[axis]) / d);
    }
    return from;
  }
  /** Whether it stays away from the edges of voxels. */
  bool isClear() const {
    bool clear = true;
    forEachVoxelAround([&](const Eigen::Array3i& v) {
      clear &= (shareIn(v, 1e-4) > 0) == (shareIn(v, -1e-4) > 0);
    });
    return clear;
  }
  template <typename F>
  void forEachVoxelAround(F f) const {
    const Eigen::Array3i low = begin.min(end).floor().cast<int>() - 1,
                         high = begin.max(end).floor().cast<int>() + 1;
    for (int x = low.x(); x <= high.x(); ++x)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int z = low.z(); z <= high.z(); ++z) f(Eigen::Array3i(x, y, z));
  }
  /** Voxels that it crosses, in order, without the last one. */
  std::vector<octomap::OcTreeKey> keys() const {
    std::vector<std::pair<double, Eigen::Array3i>> crossed;
    forEachVoxelAround([&](const Eigen::Array3i& v) {
      if (shareIn(v) > 0) crossed.emplace_back(enters(v), v);
    });
    std::sort(crossed.begin(), crossed.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<octomap::OcTreeKey> keys;
    for (const auto& [t, v] : crossed) keys.push_back(keyOf(VoxelId{v.x(), v.y(), v.z()}));
    keys.pop_back();
    return keys;
  }
};

template <typename Map>
std::vector<octomap::OcTreeKey> keysAlong(const Map& map, const octomap::point3d& a,
                                          const octomap::point3d& b) {
  octomap::KeyRay ray;
  EXPECT_TRUE(map.computeRayKeys(a, b, ray));
  return {ray.begin(), ray.end()};
}

}  // namespace

TEST(Geometry, voxelsAlongALineAreThoseThatItCrossesAndOctomaps) {
  std::mt19937 random(1);
  const SemanticOcTree map(kPlaceResolution, numberedClasses(1));
  const octomap::OcTree octree(kPlaceResolution);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const octomap::point3d a = randomPoint(random, 3), b = randomPoint(random, 3);
    const Line line{voxelsOfPoint(a), voxelsOfPoint(b)};
    if (!line.isClear()) continue;
    ++compared;
    ASSERT_EQ(keysAlong(map, a, b), line.keys()) << "line " << i;
    ASSERT_EQ(keysAlong(map, a, b), keysAlong(octree, a, b)) << "line " << i;
  }
  EXPECT_GT(compared, 1500);
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
