#include <gtest/gtest.h>
#include <map_view/OrbitCamera.h>

#include "RandomMap.h"

namespace {

using namespace map_view;

octomap::point3d pointOf(const Eigen::Vector3d& p) {
  return {float(p.x()), float(p.y()), float(p.z())};
}

Ray randomRay(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto within = [&](double x, double y, double z) {
    return Eigen::Vector3d(x * unit(random), y * unit(random), z * unit(random));
  };
  const Eigen::Vector3d origin = within(15, 15, 2) + Eigen::Vector3d(0, 0, 8);
  // Numbers that floats hold: castRay() takes no others.
  const Eigen::Vector3d exact = origin.cast<float>().cast<double>();
  const Eigen::Vector3d direction = within(12, 12, 1) - exact;
  return {exact, direction.cast<float>().cast<double>().normalized()};
}

/** The center of a voxel of this class, seen from above, m. */
Eigen::Vector2d placeAbove(const SemanticOcTree& map, ClassId id) {
  const Eigen::Array3i key = voxelOfClass(map, id);
  return {(key.x() - 32768 + 0.5) * 0.2, (key.y() - 32768 + 0.5) * 0.2};
}

}  // namespace

TEST(RayCast, HitsWhatTheMapsOwnRayHits) {
  const SemanticOcTree map = randomMap(11);
  const FullCells cells(map);
  const CellLook look(map);
  std::mt19937 random(12);
  int hits = 0, others = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray = randomRay(random);
    const auto mine = firstShown(cells, look, ray);
    const auto maps = map.castRay(pointOf(ray.origin), pointOf(ray.direction));
    ASSERT_EQ(mine.has_value(), maps.has_value()) << i;
    if (!mine) continue;
    ++hits;
    others += cells.at({maps->key[0], maps->key[1], maps->key[2]}).key() != mine->key();
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LE(others, 6) << "rays through edges round otherwise";
}

TEST(RayCast, BeginsOutsideOfTheMapAndMayMissIt) {
  const SemanticOcTree map = randomMap(13);
  const FullCells cells(map);
  const CellLook look(map);
  const double far = 0.2 * 40000;
  const Eigen::Vector2d place = placeAbove(map, 1);
  const auto below = firstShown(cells, look, {{place.x(), place.y(), far}, {0, 0, -1}});
  ASSERT_TRUE(below);
  const auto maps = map.castRay({float(place.x()), float(place.y()), 9.f}, {0, 0, -1});
  ASSERT_TRUE(maps);
  EXPECT_EQ(below->key(), maps->key);
  EXPECT_FALSE(firstShown(cells, look, {{0, 0, far}, {0, 0, 1}}));
  EXPECT_FALSE(firstShown(cells, look, {{far, 0, 0}, {0, 1, 0}}));
}

TEST(RayCast, HitsCompressedCellsWhereTheyAreDrawn) {
  SemanticOcTree map = randomMap(15);
  semantic_octree::Solution solution;
  solution.terms = {{"road", 1, {{1}}}};
  solution.alpha = 0.05;
  const LiveCompression compression(map, solution, {});
  const CompressedCells cells(map, compression);
  const CellLook look(map);
  const Eigen::Vector2d place = placeAbove(map, 1);
  const auto hit = firstShown(cells, look, {{place.x(), place.y(), 9}, {0, 0, -1}});
  ASSERT_TRUE(hit);
  const Eigen::Array3i column = voxelOfClass(map, 1);
  for (int z = 32768 + 44; z >= hit->lowest.z() + hit->edge(); --z)
    EXPECT_FALSE(cells.at({column.x(), column.y(), z}).isOccupied()) << "there is something above";
}
