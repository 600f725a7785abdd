#include <gtest/gtest.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "SmallMaps.h"
#include "TemporaryFolder.h"

using mrpt::maps::CSimplePointsMap;
using mrpt::maps::TMatchingExtraResults;
using mrpt::maps::TMatchingParams;
using mrpt::maps::TMatchingRatioParams;
using mrpt::poses::CPose2D;
using mrpt::poses::CPose3D;
using mrpt::tfest::TMatchingPairList;
using semantic_map::CSemanticOctoMap;

namespace {

CSemanticOctoMap filledMap() {
  CSemanticOctoMap map(0.2, threeClasses());
  fill(map);
  return map;
}

/** The centers of all occupied voxels, also of those that the tree has merged. */
CSimplePointsMap voxelCenters(const CSemanticOctoMap& map) {
  CSimplePointsMap points;
  const auto& tree = map.tree();
  const double voxel = tree.getResolution();
  for (auto it = tree.begin_leafs(), end = tree.end_leafs(); it != end; ++it) {
    if (!tree.isNodeOccupied(*it)) continue;
    const int n = int(std::lround(it.getSize() / voxel));
    const auto at = [&](double center, int i) {
      return float(center - it.getSize() / 2 + (i + 0.5) * voxel);
    };
    for (int x = 0; x < n; ++x)
      for (int y = 0; y < n; ++y)
        for (int z = 0; z < n; ++z)
          points.insertPoint(at(it.getX(), x), at(it.getY(), y), at(it.getZ(), z));
  }
  return points;
}

CSimplePointsMap somePoints() {
  CSimplePointsMap points;
  for (int i = 0; i < 500; ++i)
    points.insertPoint(6 * std::sin(0.37f * float(i)), 5 * std::cos(0.71f * float(i)),
                       2 * std::sin(0.13f * float(i)));
  return points;
}

}  // namespace

TEST(MapMatching, pairsPointsWithTheCentersOfVoxelsAlsoSeenFromAbove) {
  const CSemanticOctoMap map = filledMap();
  const CSimplePointsMap centers = voxelCenters(map), fromAbove = centers, points = somePoints();
  const CPose3D pose(0.31, -0.17, 0.42, 0.7, 0.05, -0.03);
  TMatchingParams params;
  params.maxDistForCorrespondence = 0.4f;
  TMatchingPairList pairs, expected, above, expectedAbove;
  TMatchingExtraResults extra, expectedExtra;
  map.determineMatching2D(&points, CPose2D(pose), above, params, extra);
  fromAbove.determineMatching2D(&points, CPose2D(pose), expectedAbove, params, expectedExtra);
  EXPECT_EQ(above.size(), expectedAbove.size());
  map.determineMatching3D(&points, pose, pairs, params, extra);
  centers.determineMatching3D(&points, pose, expected, params, expectedExtra);
  ASSERT_EQ(pairs.size(), expected.size());
  EXPECT_GT(pairs.size(), 10u);
  EXPECT_NEAR(extra.sumSqrDist, expectedExtra.sumSqrDist, 1e-4);
  EXPECT_NEAR(map.squareDistanceToClosestCorrespondence(5, 1),
              fromAbove.squareDistanceToClosestCorrespondence(5, 1), 1e-3);
}

TEST(MapMatching, isAPointsMapOfItsOccupiedVoxels) {
  CSemanticOctoMap map = filledMap();
  const auto matchesItself = [&map] {
    TMatchingRatioParams near;
    near.maxDistForCorr = 1e-3f;
    const CSimplePointsMap* points = std::as_const(map).getAsSimplePointsMap();
    return points && points->size() == voxelCenters(map).size() &&
           map.compute3DMatchingRatio(points, CPose3D(), near) == 1.f;
  };
  EXPECT_TRUE(matchesItself());
  EXPECT_EQ(map.compute3DMatchingRatio(&map, CPose3D(), {}), 1.f) << "a semantic map is one, too";
  const std::size_t before = map.getAsSimplePointsMap()->size();
  semantic_types::LabeledCloud more;
  for (int i = 0; i < 8; ++i) more.points.emplace_back(3.f, 0.3f * float(i), 1.f);
  for (int scan = 0; scan < 5; ++scan) map.tree().insert(more, Eigen::Isometry3d::Identity(), {});
  EXPECT_GT(map.getAsSimplePointsMap()->size(), before) << "as it is now";
  EXPECT_TRUE(matchesItself());
  map.clear();
  EXPECT_EQ(map.getAsSimplePointsMap()->size(), 0u);
}

#if MSO_MRPT_AT_LEAST(2, 11, 3)
TEST(MapMatching, tellsNearestVoxelsAsPointsMapsDo) {
  CSemanticOctoMap map = filledMap();
  const auto* nearest = dynamic_cast<const mrpt::maps::NearestNeighborsCapable*>(&map);
  ASSERT_NE(nearest, nullptr);
  const std::size_t count = nearest->nn_index_count();
  EXPECT_EQ(count, voxelCenters(map).size());
  const mrpt::math::TPoint3Df query(1.f, 0.5f, 0.2f);
  mrpt::math::TPoint3Df found;
  float squared = 0;
  std::uint64_t index = 0;
  ASSERT_TRUE(nearest->nn_single_search(query, found, squared, index));
  EXPECT_NEAR((found - query).sqrNorm(), squared, 1e-4f);
  std::vector<mrpt::math::TPoint3Df> all;
  std::vector<float> distances;
  std::vector<std::uint64_t> indices;
  nearest->nn_multiple_search(query, count, all, distances, indices);
  ASSERT_EQ(all.size(), count);
  EXPECT_EQ(*std::min_element(distances.begin(), distances.end()), squared);
  nearest->nn_radius_search(query, 4 * squared, all, distances, indices, 0);
  EXPECT_GE(all.size(), 1u);
  EXPECT_LE(*std::max_element(distances.begin(), distances.end()), 4 * squared);
  map.clear();
  EXPECT_FALSE(nearest->nn_single_search(query, found, squared, index));
  nearest->nn_multiple_search(query, 3, all, distances, indices);
  EXPECT_TRUE(all.empty() && distances.empty() && indices.empty());
}
#endif

TEST(MapMatching, whatCannotBeMatchedIsRefused) {
  const CSemanticOctoMap map = filledMap();
  const mrpt::maps::COccupancyGridMap2D grid;
  EXPECT_TRUE(contains(errorOf([&] { map.compute3DMatchingRatio(&grid, CPose3D(), {}); }),
                       "COccupancyGridMap2D"));
  EXPECT_THROW(map.compute3DMatchingRatio(nullptr, CPose3D(), {}), std::invalid_argument);
  EXPECT_THROW(CSemanticOctoMap().squareDistanceToClosestCorrespondence(0, 0), std::logic_error);
  const CSimplePointsMap none;
  EXPECT_EQ(map.compute3DMatchingRatio(&none, CPose3D(), {}), 0.f);
}
