#include <synthetic_world/Scene.h>

#include <synthetic_world/Objects.h>

#include <cmath>
#include <stdexcept>

#include "SceneBuilder.h"

namespace synthetic_world {
namespace {

struct Maker {
  const char* name;
  Scene (*make)(std::uint64_t seed, double hills);
};
constexpr Maker kMakers[] = {{"village", makeVillage}, {"park", makePark}, {"campus", makeCampus}};

}  // namespace

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const Maker& m : kMakers) names.emplace_back(m.name);
  return names;
}

Scene makeScene(const std::string& name, std::uint64_t seed, double hills) {
  if (!(hills >= 0 && hills <= 2))
    throw std::invalid_argument("scene: hills is " + std::to_string(hills) + ", 0 to 2 expected");
  std::string known;
  for (const Maker& m : kMakers) {
    if (name == m.name) return m.make(seed, hills);
    known += (known.empty() ? "" : ", ") + std::string(m.name);
  }
  throw std::invalid_argument("scene: no scene '" + name + "'; there are: " + known);
}

Eigen::Isometry3d Scene::T_world_robot(double s) const {
  const Eigen::Vector2d at = route.at(s);
  return world.poseOnGround(at.x(), at.y(), route.heading(s));
}

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
    const double y = b.random.chance(0.5) ? -15.5 : -2.0, x = b.random.uniform(-32, 32);
    const Eigen::Vector2d at(x, y);
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
  return b.finish(ring.parallel(-kCampusLane));
}

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
  return b.finish(loop.parallel(-0.9));
}

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
  return b.finish(ring.parallel(-kVillageLane));
}

}  // namespace synthetic_world
