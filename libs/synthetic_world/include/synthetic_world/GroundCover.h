#pragma once
#include <synthetic_world/Classes.h>
#include <synthetic_world/Curve.h>
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace synthetic_world {

/** Which class the ground has where: a floor painted stroke over stroke. */
class GroundCover {
 public:
  /** \param halfExtent Half the edge of the square around the origin that is painted, meters.
   * \param background Class of what no stroke covers. */
  GroundCover(double halfExtent, ClassId background);

  /** A stroke with round ends, of half width `radius`, from a to b (a disk if they are equal). */
  void paintStroke(ClassId id, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius);
  void paintDisk(ClassId id, const Eigen::Vector2d& center, double radius) {
    paintStroke(id, center, center, radius);
  }
  /** A rectangle from a to b (the middles of its short sides), `width` meters wide. */
  void paintBand(ClassId id, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width);
  /** The strip of half width `radius` around a curve. */
  void paintCurve(ClassId id, const Curve& curve, double radius);

  /** Class of what was painted last at (x, y). */
  ClassId at(double x, double y) const;
  ClassId at(const Eigen::Vector2d& p) const { return at(p.x(), p.y()); }

 private:
  struct Stroke {
    Eigen::Vector2d start, direction;  // direction: unit
    double length, radius;
    bool round;
    ClassId id;
    bool covers(const Eigen::Vector2d& p) const;
  };
  void paint(const Stroke& stroke);
  int cellOf(double coordinate) const;

  double m_halfExtent;
  int m_width;  // cells in a row
  ClassId m_background;
  std::vector<Stroke> m_strokes;
  std::vector<std::vector<std::uint32_t>> m_cells;  // strokes that may cover a cell, in order
};

}  // namespace synthetic_world
