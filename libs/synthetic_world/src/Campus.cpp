#include <cmath>

#include "SceneBuilder.h"

namespace synthetic_world {
namespace {

constexpr double kCampusLane = 1.3;

struct Block {
  Eigen::Vector2d at, size;
  double yaw;
  int storeys;
  Color tint;
};

void blocks(SceneBuilder& b) {
  const Block all[] = {{{-22, 12}, {20, 10}, M_PI, 3, {204, 196, 184}},
                       {{18, 14}, {22, 10}, M_PI, 4, {176, 92, 74}},
                       {{-56, 12}, {24, 11}, M_PI / 2, 4, {214, 206, 186}},
                       {{58, 3}, {26, 11}, -M_PI / 2, 3, {148, 158, 168}},
                       {{-18, -48}, {28, 11}, 0, 3, {192, 176, 152}},
                       {{26, 52}, {26, 11}, M_PI, 2, {206, 208, 206}},
                       {{-24, 51}, {22, 11}, M_PI, 4, {186, 116, 92}}};
  for (const Block& block : all)
    b.add(synthetic_world::block(b.onGround(block.at), block.yaw, block.size, block.storeys,
                                 block.tint));
}

void plaza(SceneBuilder& b) {
  b.cover.paintBand(kSidewalk, {-34, -9}, {34, -9}, 22);
  b.cover.paintBand(kSidewalk, {0, 0}, {0, 32}, 6);
  b.cover.paintDisk(kWater, {0, -9}, 4.2);
  for (const double x : {-24.0, -12.0, 12.0, 24.0}) {
    b.cover.paintBand(kGrass, {x - 4.5, -9}, {x + 4.5, -9}, 8);
    b.cover.paintBand(kFlowerBed, {x - 3, -9}, {x + 3, -9}, 2.2);
    for (const double y : {-11.6, -6.4}) b.add(broadleafTree(b.onGround({x, y}), b.random));
    b.add(bench(b.onGround({x, -14}), M_PI / 2));
    b.add(bench(b.onGround({x, -4}), -M_PI / 2));
  }
  for (int i = 0; i < 9; ++i) {
    const Eigen::Vector2d at(b.random.uniform(-32, 32), b.random.chance(0.5) ? -15.5 : -2.0);
    const double yaw = b.random.uniform(-M_PI, M_PI);
    b.add(person(b.onGround(at), yaw, {188, 62, 52}, b.random.uniform()));
  }
}

/** Rows of marked bays, some with cars. */
void parkingLot(SceneBuilder& b) {
  const double x0 = 14, x1 = 40;
  b.cover.paintBand(kRoad, {x0 - 2, -49}, {x1 + 2, -49}, 22);
  b.cover.paintBand(kRoad, {27, -45}, {27, -28}, 6);
  for (const double y : {-56.5, -41.5})
    for (double x = x0; x <= x1; x += 2.6) {
      if (y > -50 && std::abs(x - 27) < 4.5) continue;
      b.cover.paintBand(kLaneMarking, {x, y - 2.4}, {x, y + 2.4}, 0.14);
      const Color paints[] = {{168, 34, 38}, {36, 64, 128}, {206, 208, 210}, {52, 54, 58}};
      if (x + 2.6 <= x1 && b.random.chance(0.6))
        b.add(car(b.onGround({x + 1.3, y}), M_PI / 2, paints[b.random.below(4)]));
    }
}

void avenue(SceneBuilder& b, const Road& road, double left) {
  b.along(road.middle, 9, [&](double s) {
    const Eigen::Vector2d at = road.middle.beside(s, left);
    if (b.hasRoom(at, 0.8, 1.2)) b.add(broadleafTree(b.onGround(at), b.random));
  });
}

}  // namespace

Scene makeCampus(std::uint64_t seed, double hills) {
  SceneBuilder b(75, {{0.9, 88, 0.2, 0.8}, {0.7, 60, 1.8, 2.6}, {0.35, 37, 2.8, 0.2}}, hills, seed);
  const Curve ring({{-42, -27}, {42, -27}, {42, 36}, {-42, 36}}, 10, true);
  const std::vector<Road> roads{{ring, 4.0, 2.2, true},
                                {Curve({{-75, -27}, {-40, -27}}, 5), 3.6, 2.0, true},
                                {Curve({{42, 26}, {75, 26}}, 5), 3.6, 2.0, true},
                                {Curve({{-42, 30}, {-48, 50}, {-42, 75}}, 12), 3.2, 1.8, true}};
  plaza(b);
  b.cover.paintCurve(kDirt, Curve({{-38, 22}, {-12, 21}, {-4, 30}}, 8), 0.7);
  b.cover.paintCurve(kGravel, Curve({{4, 21}, {30, 24}, {38, 20}}, 8), 1.1);
  b.roads(roads);
  parkingLot(b);
  blocks(b);
  b.zebra(roads[0], 32);
  b.zebra(roads[0], ring.length() - 98);
  b.parkedCars(roads[0], 10);
  b.lamps(roads[0], 18);
  b.people(roads[0], 26);
  avenue(b, roads[0], 8.2);
  avenue(b, roads[0], -8.2);
  b.enclosure(ring, 0, 34, -8.6, kFence);
  b.enclosure(ring, 100, 130, -8.6, kWall);
  b.enclosure(ring, 150, 190, -8.6, kBush);
  b.trees(90, {{-73, -73}, {73, 73}}, 0.15);
  b.bushes(40, {{-60, -60}, {60, 60}});
  b.scatter(10, {{-40, -24}, {40, 34}}, 0.9, 0.3,
            [&](const Eigen::Vector3d& base) { b.add(rock(base, b.random)); });
  return b.finish("campus", seed, ring.parallel(-kCampusLane));
}

}  // namespace synthetic_world
