#pragma once
#include <synthetic_world/Objects.h>
#include <synthetic_world/Scene.h>
#include <functional>

namespace synthetic_world {

struct Road {
  Curve middle;
  double halfWidth;        // m
  double sidewalk = 0;     // width on both sides, m
  bool laneMarks = false;  // a dashed line in the middle
  ClassId surface = kRoad;
};

/** A part of the plane in which things are scattered. */
struct Region {
  Eigen::Vector2d low, high;
};

/** Lays out a scene: first the ground, then what stands on it, each where there is room. */
class SceneBuilder {
 public:
  SceneBuilder(int halfExtent, std::vector<Terrain::Wave> waves, double hills, std::uint64_t seed);

  Random random;
  GroundCover cover;

  Eigen::Vector3d onGround(const Eigen::Vector2d& p) const;
  void add(const Solids& solids);
  /** Is all of the polygon's ground grass, and no solid nearer than `margin`? */
  bool hasRoom(const Polygon& polygon, double margin) const;
  bool hasRoom(const Eigen::Vector2d& center, double radius, double margin) const;

  /** Paints sidewalks, then surfaces (the first road's last: it goes through), then marks. */
  void roads(const std::vector<Road>& roads);
  /** Stripes for pedestrians across a road. */
  void zebra(const Road& road, double s);

  /** Calls f(s, random length) every `spacing` meters or so, give or take a quarter. */
  void along(const Curve& curve, double spacing, const std::function<void(double s)>& f);
  /** Calls f at `count` random spots with a free disk of this radius around, if they are found. */
  void scatter(int count, const Region& region, double radius, double margin,
               const std::function<void(const Eigen::Vector3d& base)>& f);

  void trees(int count, const Region& region, double coniferShare);
  void bushes(int count, const Region& region);
  void houses(const Road& road, double left);
  void parkedCars(const Road& road, double spacing);
  void lamps(const Road& road, double spacing);
  void people(const Road& road, double spacing);
  /** Fence, wall or hedge beside a curve wherever there is room for a panel. */
  void enclosure(const Curve& curve, double from, double to, double left, ClassId id);

  Scene finish(Curve route);

 private:
  void garden(const Road& road, double s, double left, const Eigen::Vector2d& door);
  Color carColor();
  Color clothesColor();

  Terrain m_terrain;
  Solids m_solids;
};

Scene makeVillage(std::uint64_t seed, double hills);
Scene makePark(std::uint64_t seed, double hills);
Scene makeCampus(std::uint64_t seed, double hills);

}  // namespace synthetic_world
