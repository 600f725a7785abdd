#pragma once
#include <semantic_types/ClassTable.h>
#include <Eigen/Core>

#include <optional>
#include <variant>
#include <vector>

namespace synthetic_world {

using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::Color;
using semantic_types::kNoClass;

/** The classes of every synthetic scene, in the order of config/classes/synthetic.yaml. */
enum Class : ClassId {
  kRoad = 1,
  kLaneMarking,
  kSidewalk,
  kGravel,
  kDirt,
  kGrass,
  kFlowerBed,
  kWater,
  kTrunk,
  kCanopy,
  kBush,
  kRock,
  kBuilding,
  kWindow,
  kRoof,
  kWall,
  kFence,
  kPole,
  kSign,
  kBench,
  kCar,
  kPerson
};
constexpr int kClassCount = kPerson;

/** The names of the classes, and the colors in which maps show them. */
const ClassTable& classTable();

/** What such things look like to a color camera. */
Color naturalColor(ClassId id);

/** Corners of a convex polygon, counterclockwise. */
using Polygon = std::vector<Eigen::Vector2d>;

/** The rectangle of this length (along the yaw's direction) and width around a center. */
Polygon rectangle(const Eigen::Vector2d& center, double yaw, double length, double width);

/** The polygon turned by yaw, then moved. */
Polygon placed(const Polygon& polygon, const Eigen::Vector2d& position, double yaw);

/** Distance in meters; 0 for a point inside. */
double distance(const Polygon& polygon, const Eigen::Vector2d& point);

/** Distance in meters; 0 for polygons that touch or overlap. */
double distance(const Polygon& a, const Polygon& b);

/** Where a ray enters a shape. */
struct Entry {
  double range;  // meters; 0 if the ray starts inside
  Eigen::Vector3d normal;
  int face;
};

/** What a robot between two heights sees of a shape: a disk or a convex polygon in the plane.
 * Slanted parts count with their greatest extent. */
struct Section {
  Polygon outline;  // empty: a disk
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double radius = 0;

  double distanceTo(const Polygon& polygon) const;
};

// Each shape is convex and answers:
//   enter(origin, direction)  where a ray of unit direction enters it,
//   signedDistance(p)         0 on its surface, negative inside; outside a lower bound,
//                             exact beside a face
//                             (a spheroid: to first order near its surface),
//   nearestFace(p)            the face that signedDistance speaks of,
//   section(low, high)        what of it lies between two heights, if anything,
//   low(), high()             its heights.

/** An intersection of half spaces: box, gabled roof, pyramid stump. */
class Polyhedron {
 public:
  struct Face {
    Eigen::Vector3d normal;  // unit, outward
    double offset;           // inside: normal.dot(p) <= offset
    double u0, width;        // horizontal coordinate of the face's left edge, and its width
  };
  /** A prism on a convex outline; with a smaller outline of as many corners on top, a stump whose
   * sides lean inward. The sides are the faces 0..n-1, the top n, the bottom n+1. */
  Polyhedron(const Polygon& bottom, const Polygon& top, double low, double high);
  /** A roof: the ridge runs along the yaw's direction at `high` above the middle of a rectangle. */
  static Polyhedron gable(const Eigen::Vector2d& center, double yaw, double length, double width,
                          double low, double high);

  std::optional<Entry> enter(const Eigen::Vector3d& o, const Eigen::Vector3d& d) const;
  double signedDistance(const Eigen::Vector3d& p) const;
  int nearestFace(const Eigen::Vector3d& p) const;
  std::optional<Section> section(double low, double high) const;
  double low() const { return m_low; }
  double high() const { return m_high; }

  const Face& face(int i) const { return m_faces[i]; }

 private:
  Polyhedron() = default;
  void addSide(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& above);

  std::vector<Face> m_faces;
  Polygon m_outline;
  double m_low = 0, m_high = 0;
};

/** An upright cylinder, cone or stump of a cone. */
struct Shaft {
  Eigen::Vector2d center;
  double bottomRadius, topRadius, bottom, top;

  std::optional<Entry> enter(const Eigen::Vector3d& o, const Eigen::Vector3d& d) const;
  double signedDistance(const Eigen::Vector3d& p) const;
  int nearestFace(const Eigen::Vector3d&) const { return 0; }
  std::optional<Section> section(double from, double to) const;
  double low() const { return bottom; }
  double high() const { return top; }
  /** Radius at a height, as if the shaft had no ends. */
  double radiusAt(double z) const { return bottomRadius + slope() * (z - bottom); }
  double slope() const { return (topRadius - bottomRadius) / (top - bottom); }
};

/** A ball, stretched along the vertical. */
struct Spheroid {
  Eigen::Vector3d center;
  double radius, halfHeight;

  std::optional<Entry> enter(const Eigen::Vector3d& o, const Eigen::Vector3d& d) const;
  double signedDistance(const Eigen::Vector3d& p) const;
  int nearestFace(const Eigen::Vector3d&) const { return 0; }
  std::optional<Section> section(double from, double to) const;
  double low() const { return center.z() - halfHeight; }
  double high() const { return center.z() + halfHeight; }
};

using Shape = std::variant<Polyhedron, Shaft, Spheroid>;

constexpr double kStorey = 2.9;  ///< m: a row of windows in each

/** A class, and the color in which a camera sees it. */
struct Material {
  ClassId id = kNoClass;
  Color tint;

  Material() = default;
  /** The class in its natural color. */
  Material(ClassId c) : id(c), tint(naturalColor(c)) {}  // NOLINT: a class is a material
  Material(ClassId c, Color color) : id(c), tint(color) {}
};

/** One thing of the world, or a part of one. */
class Solid {
 public:
  /** \param top Material of the faces that look up. */
  Solid(Shape shape, Material side, Material top);
  Solid(Shape shape, Material material) : Solid(std::move(shape), material, material) {}

  /** Puts windows of this class into the upright faces of a polyhedron, storey over storey from the
   * height `floor` on. */
  Solid& withWindows(double floor);

  std::optional<Entry> enter(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  double signedDistance(const Eigen::Vector3d& p) const;
  std::optional<Section> section(double low, double high) const;
  double low() const;
  double high() const;
  /** A disk in the plane that holds the whole solid. */
  const Eigen::Vector2d& center() const { return m_center; }
  double radius() const { return m_radius; }

  /** Material of the point p of a face. */
  Material materialAt(const Eigen::Vector3d& p, int face) const;
  /** Material of the surface nearest to p. */
  Material materialAt(const Eigen::Vector3d& p) const;

 private:
  bool isWindow(const Polyhedron::Face& face, const Eigen::Vector3d& p) const;

  Shape m_shape;
  Material m_side, m_top;
  std::optional<double> m_windowFloor;
  Eigen::Vector2d m_center = Eigen::Vector2d::Zero();
  double m_radius = 0;
};

using Solids = std::vector<Solid>;

}  // namespace synthetic_world
