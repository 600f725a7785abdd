#include <cmath>

#include "SceneBuilder.h"

namespace synthetic_world {
namespace {

const std::vector<Eigen::Vector2d> kLoop{{-34, -20}, {-4, -30}, {30, -22}, {36, 8},
                                         {16, 30},   {-20, 26}, {-38, 6}};

void lake(SceneBuilder& b) {
  const Eigen::Vector2d middle(4, -4);
  std::vector<Eigen::Vector2d> bays;
  for (int i = 0; i < 6; ++i) {
    const double angle = i * M_PI / 3, away = b.random.uniform(2.5, 5.5);
    bays.push_back(middle + away * Eigen::Vector2d(1.4 * std::cos(angle), std::sin(angle)));
  }
  for (const Eigen::Vector2d& bay : bays) b.cover.paintDisk(kDirt, bay, 5.4);
  for (const Eigen::Vector2d& bay : bays) b.cover.paintDisk(kWater, bay, 4.4);
}

void flowerBeds(SceneBuilder& b) {
  for (const Eigen::Vector2d& c :
       {Eigen::Vector2d(-22, 4), {-14, 15}, {20, 16}, {24, -12}, {-20, -12}}) {
    b.cover.paintDisk(kSidewalk, c, 2.6);
    b.cover.paintDisk(kFlowerBed, c, 2.1);
  }
}

void benches(SceneBuilder& b, const Road& path) {
  b.along(path.middle, 13, [&](double s) {
    const double left = b.random.chance(0.5) ? 1 : -1;
    const Eigen::Vector2d at = path.middle.beside(s, left * (path.halfWidth + 1.3));
    if (b.hasRoom(at, 0.6, 0.3))
      b.add(bench(b.onGround(at), path.middle.heading(s) - left * M_PI / 2));
  });
}

void kiosk(SceneBuilder& b) {
  const Eigen::Vector2d at(-31.5, 25.6);
  b.cover.paintDisk(kSidewalk, at, 5.5);
  b.add(house(b.onGround(at), -0.74 - M_PI / 2, {6, 5}, 1, b.random));
}

}  // namespace

Scene makePark(std::uint64_t seed, double hills) {
  SceneBuilder b(
      70, {{2.2, 66, 0.9, 2.2}, {1.6, 47, 2.5, 0.4}, {0.6, 29, 0.1, 1.0}, {0.9, 105, 1.6, 5.0}},
      hills, seed);
  const Curve loop(kLoop, 14, true);
  const std::vector<Road> roads{
      {loop, 2.4, 0, false},
      {Curve({{30, -22}, {50, -32}, {70, -34}}, 15), 2.4, 0, false},
      {Curve({{-38, 2}, {-18, 4}, {-6, 16}, {0, 29}}, 9), 1.1, 0, false, kGravel},
      {Curve({{-6, 16}, {14, 14}, {24, 20}}, 8), 1.1, 0, false, kGravel},
      {Curve({{-20, 4}, {-14, -12}, {-10, -28}}, 8), 1.1, 0, false, kGravel},
      {Curve({{34, -6}, {22, -10}, {16, -27}}, 6), 1.1, 0, false, kGravel}};
  lake(b);
  kiosk(b);
  b.roads(roads);
  flowerBeds(b);
  for (std::size_t i = 2; i < roads.size(); ++i) {
    benches(b, roads[i]);
    b.people(roads[i], 26);
  }
  b.people(roads[0], 40);
  b.lamps(roads[0], 20);
  b.enclosure(loop, 8, 34, -5.0, kFence);
  b.enclosure(loop, 90, 112, -5.0, kWall);
  b.enclosure(loop, 120, 150, -4.6, kBush);
  const Region all{{-68, -68}, {68, 68}};
  b.trees(170, all, 0.35);
  b.bushes(70, {{-50, -45}, {50, 45}});
  b.scatter(24, {{-40, -40}, {40, 40}}, 0.9, 0.3,
            [&](const Eigen::Vector3d& base) { b.add(rock(base, b.random)); });
  const Eigen::Vector2d visitor = roads[1].middle.beside(16, -1.4);
  b.add(car(b.onGround(visitor), roads[1].middle.heading(16), {216, 214, 206}));
  return b.finish("park", seed, loop.parallel(-0.9));
}

}  // namespace synthetic_world
