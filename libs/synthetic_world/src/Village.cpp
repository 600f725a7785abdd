#include "SceneBuilder.h"

namespace synthetic_world {
namespace {

constexpr double kVillageLane = 1.1, kRadius = 12;

const std::vector<Eigen::Vector2d> kRing{{-38, -22}, {4, -14}, {42, -22},
                                         {40, 24},   {2, 32},  {-40, 22}};

void pond(SceneBuilder& b) {
  b.cover.paintDisk(kGravel, {-12, 8}, 6.4);
  for (const Eigen::Vector2d& c :
       {Eigen::Vector2d(-14, 7), Eigen::Vector2d(-11, 9), Eigen::Vector2d(-10, 6.5)})
    b.cover.paintDisk(kWater, c, 3.0);
  b.cover.paintCurve(kGravel, Curve({{-12, 2}, {-9, -4}, {-11, -14}}, 5), 0.9);
  b.cover.paintCurve(kGravel, Curve({{-6, 9}, {4, 12}, {6, 28}}, 6), 0.9);
  b.add(bench(b.onGround({-18.4, 12.2}), -0.7));
  b.add(bench(b.onGround({-5.3, 11.8}), -2.6));
}

void field(SceneBuilder& b) {
  b.cover.paintBand(kDirt, {22, -52}, {66, -60}, 17);
  const Curve edge({{20, -42}, {64, -50}}, 1);
  b.enclosure(edge, 0, edge.length(), 0, kBush);
}

/** A church with its tower: the landmark. */
void church(SceneBuilder& b) {
  const Eigen::Vector2d at(22, 4);
  b.cover.paintBand(kSidewalk, at + Eigen::Vector2d(-12, 0), at + Eigen::Vector2d(9, 0), 12);
  b.cover.paintBand(kSidewalk, {10, 4}, {10, -12}, 2.4);
  const Eigen::Vector3d base = b.onGround(at);
  b.add(house(base, 0.0, {13, 8}, 2, b.random));
  const Eigen::Vector2d tower = at + Eigen::Vector2d(-8, 0);
  const Polygon square = rectangle(tower, 0, 3.6, 3.6), tip = rectangle(tower, 0, 0.2, 0.2);
  const Material plaster(kBuilding, {222, 212, 196}), slate(kRoof, {92, 96, 104});
  b.add({{Polyhedron(square, square, base.z() - 2, base.z() + 11), plaster},
         {Polyhedron(square, tip, base.z() + 11, base.z() + 17), slate}});
}

}  // namespace

Scene makeVillage(std::uint64_t seed, double hills) {
  SceneBuilder b(
      75, {{1.5, 74, 0.4, 0.3}, {1.1, 52, 1.9, 1.2}, {0.45, 31, 2.7, 2.0}, {0.7, 96, -0.6, 4.0}},
      hills, seed);
  const Curve ring(kRing, kRadius, true);
  const std::vector<Road> roads{
      {ring, 3.9, 1.7, true},
      {Curve({{-75, -30}, {-50, -26}, {-30, -20.4}}, 20), 3.2, 1.5, true},
      {Curve({{41, 2}, {58, 4}, {75, 10}}, 20), 3.2, 1.5, true},
      {Curve({{-12, 29}, {-16, 48}, {-8, 75}}, 15), 2.2, 0, false, kDirt}};
  pond(b);
  church(b);
  field(b);
  b.roads(roads);
  b.zebra(roads[0], 30);
  b.parkedCars(roads[0], 11);
  for (const Road& road : roads) {
    b.houses(road, 1);
    b.houses(road, -1);
  }
  b.lamps(roads[0], 17);
  b.people(roads[0], 24);
  const Region all{{-73, -73}, {73, 73}};
  b.trees(90, all, 0.25);
  b.trees(10, {{-34, -16}, {10, 24}}, 0.0);
  b.bushes(50, {{-55, -45}, {55, 50}});
  b.scatter(8, {{-24, -6}, {0, 22}}, 0.9, 0.3,
            [&](const Eigen::Vector3d& base) { b.add(rock(base, b.random)); });
  return b.finish("village", seed, ring.parallel(-kVillageLane));
}

}  // namespace synthetic_world
