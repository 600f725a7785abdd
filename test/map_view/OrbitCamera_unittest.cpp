#include <gtest/gtest.h>
#include <map_view/OrbitCamera.h>

#include <algorithm>
#include <random>

#include "CommaHost.h"
#include "RandomMap.h"
#include "TemporaryFolder.h"

namespace {

using map_view::OrbitCamera;
using map_view::Ray;

constexpr int kWidth = 1280, kHeight = 720;

OrbitCamera someCamera(double azimuth, double elevation) {
  OrbitCamera camera;
  camera.target = {3, -4, 2};
  camera.distance = 25;
  camera.azimuth = azimuth, camera.elevation = elevation;
  return camera;
}

/** Pixels from the left and from the top. */
Eigen::Vector2d pixelOf(const OrbitCamera& camera, const Eigen::Vector3d& p) {
  const Eigen::Vector3d to = p - camera.position();
  const double scale = camera.focalLength(kHeight) / to.dot(camera.forward());
  return {kWidth / 2.0 + scale * to.dot(camera.right()),
          kHeight / 2.0 - scale * to.dot(camera.up())};
}

TEST(OrbitCamera, SaysWhereAPlaceIsSeen) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> meters(-40, 40);
  int behind = 0;
  for (int i = 0; i < 200; ++i) {
    const OrbitCamera camera = someCamera(meters(random) * 4, meters(random) * 2);
    const Eigen::Vector3d place(meters(random), meters(random), meters(random));
    const auto pixel = camera.pixelOf(place, kWidth, kHeight);
    const bool isAhead = (place - camera.position()).dot(camera.forward()) > 0;
    ASSERT_EQ(pixel.has_value(), isAhead);
    behind += !isAhead;
    if (pixel) {
      EXPECT_LT((*pixel + Eigen::Vector2d(0.5, 0.5) - pixelOf(camera, place)).norm(), 1e-6);
    }
  }
  EXPECT_GT(behind, 10);
}

TEST(OrbitCamera, LooksNorthUpFromAboveAndEastFromTheWest) {
  const OrbitCamera top = someCamera(-90, 90);
  EXPECT_TRUE(top.position().isApprox(Eigen::Vector3d(3, -4, 27), 1e-9));
  EXPECT_TRUE(top.right().isApprox(Eigen::Vector3d(1, 0, 0), 1e-9)) << "east is right";
  EXPECT_TRUE(top.up().isApprox(Eigen::Vector3d(0, 1, 0), 1e-9));
  const OrbitCamera west = someCamera(180, 0);
  EXPECT_TRUE(west.position().isApprox(Eigen::Vector3d(-22, -4, 2), 1e-9));
  EXPECT_TRUE(west.forward().isApprox(Eigen::Vector3d(1, 0, 0), 1e-9));
  EXPECT_TRUE(west.up().isApprox(Eigen::Vector3d(0, 0, 1), 1e-9));
}

TEST(OrbitCamera, RaysGoThroughTheirPixels) {
  for (const double elevation : {-30.0, 10.0, 60.0, 90.0}) {
    const OrbitCamera camera = someCamera(37, elevation);
    for (const int x : {0, 300, 640, 1279})
      for (const int y : {0, 100, 719}) {
        const Ray ray = camera.rayThrough(x, y, kWidth, kHeight);
        EXPECT_NEAR(ray.direction.norm(), 1, 1e-12);
        const Eigen::Vector2d pixel = pixelOf(camera, ray.origin + 17 * ray.direction);
        EXPECT_NEAR(pixel.x(), x + 0.5, 1e-6);
        EXPECT_NEAR(pixel.y(), y + 0.5, 1e-6);
      }
  }
}

TEST(OrbitCamera, SeesAllOfABoxAndNoMore) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-10, -60, 0), Eigen::Vector3d(40, 20, 6));
  for (const double elevation : {5.0, 40.0, 90.0}) {
    const OrbitCamera camera = someCamera(-70, elevation).seeing(box, kWidth, kHeight);
    double most = 0;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector2d pixel =
          pixelOf(camera, box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
      most = std::max({most, std::fabs(pixel.x() - kWidth / 2.0) / (kWidth / 2.0),
                       std::fabs(pixel.y() - kHeight / 2.0) / (kHeight / 2.0)});
    }
    EXPECT_NEAR(most, 1, 1e-6) << elevation;
  }
}

TEST(OrbitCamera, NeverLosesABallThatIsSeen) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> unit(-1, 1);
  const OrbitCamera camera = someCamera(20, 30);
  int unseen = 0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d center = 60 * Eigen::Vector3d(unit(random), unit(random), unit(random));
    const double radius = 1 + unit(random);
    const bool may = camera.maySee(center, radius, kWidth, kHeight);
    unseen += !may;
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector3d in(unit(random), unit(random), unit(random));
      if (in.norm() > 1) continue;
      const Eigen::Vector3d p = center + radius * in;
      if ((p - camera.position()).dot(camera.forward()) <= 0) continue;
      const Eigen::Vector2d pixel = pixelOf(camera, p);
      const bool seen =
          pixel.x() >= 0 && pixel.x() < kWidth && pixel.y() >= 0 && pixel.y() < kHeight;
      EXPECT_TRUE(may || !seen) << i;
    }
  }
  EXPECT_GT(unseen, 1000);
}

TEST(OrbitCamera, IsWrittenAndRead) {
  OrbitCamera camera = someCamera(-120, 35.5);
  camera.target.x() = 0.125;
  const CommaHost host;
  const OrbitCamera read = OrbitCamera::ofText(camera.text());
  EXPECT_EQ(read.text(), "0.125,-4,2,25,-120,35.5");
  EXPECT_EQ(read.target, camera.target);
}

TEST(OrbitCamera, RefusesWhatIsNoCamera) {
  for (const char* text : {"", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,3,0,5,6", "1,2,3,4,5,91",
                           "1,2,x,4,5,6", "nan,2,3,4,5,6", "1,2,3,inf,5,6"})
    EXPECT_NE(errorOf([&] { OrbitCamera::ofText(text); }), "") << text;
}

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
  const CellSource cells(map);
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
  const CellSource cells(map);
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
  semantic_octree::AbstractionOptions options;
  options.weights = {{{"road", 1, {{1}}}}, 0.05};
  const LiveCompression compression(map, options);
  const CellSource cells(map, &compression);
  const CellLook look(map);
  const Eigen::Vector2d place = placeAbove(map, 1);
  const auto hit = firstShown(cells, look, {{place.x(), place.y(), 9}, {0, 0, -1}});
  ASSERT_TRUE(hit);
  const Eigen::Array3i column = voxelOfClass(map, 1);
  for (int z = 32768 + 44; z >= hit->lowest.z() + hit->edge(); --z)
    EXPECT_FALSE(cells.at({column.x(), column.y(), z}).isOccupied()) << "there is something above";
}
