#include <gtest/gtest.h>
#include <map_view/RayCast.h>

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
  const auto below = firstShown(cells, look, {{0.1, -3.9, far}, {0, 0, -1}});
  ASSERT_TRUE(below);
  EXPECT_EQ(below->key(), map.castRay({0.1f, -3.9f, 9.f}, {0, 0, -1})->key);
  EXPECT_FALSE(firstShown(cells, look, {{0, 0, far}, {0, 0, 1}}));
  EXPECT_FALSE(firstShown(cells, look, {{far, 0, 0}, {0, 1, 0}}));
}

TEST(RayCast, GoesThroughWhatIsHidden) {
  const SemanticOcTree map = randomMap(14);
  const FullCells cells(map);
  CellLook look(map);
  const Ray down = {{5.1, 3.1, 9}, {0, 0, -1}};
  const auto top = firstShown(cells, look, down);
  ASSERT_TRUE(top);
  ViewStyle style;
  style.maxHeight = top->centerHeight(0.2) - 0.05;
  look.setStyle(style);
  const auto second = firstShown(cells, look, down);
  ASSERT_TRUE(second);
  EXPECT_LT(second->lowest.z(), top->lowest.z());
}

TEST(RayCast, HitsCompressedCellsWhereTheyAreDrawn) {
  SemanticOcTree map = randomMap(15);
  semantic_octree::AbstractionOptions options;
  options.weights.terms = {{"road", 1, {{1}}}};
  options.weights.alpha = 0.05;
  map.setAbstraction(options);
  const CompressedCells cells(map);
  const CellLook look(map);
  const auto hit = firstShown(cells, look, {{0.1, -3.9, 9}, {0, 0, -1}});
  ASSERT_TRUE(hit);
  for (int z = 32768 + 44; z >= hit->lowest.z() + hit->edge(); --z)
    EXPECT_FALSE(cells.at({32768, 32748, z}).isOccupied()) << "there is something above";
}
