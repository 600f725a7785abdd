#pragma once
#include <synthetic_world/Classes.h>
#include <synthetic_world/Shapes.h>

namespace synthetic_world {

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
