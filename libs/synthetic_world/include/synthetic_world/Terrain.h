#pragma once
#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

namespace synthetic_world {

/** The hills: a square of ground around the origin whose height is interpolated bilinearly between
 * the nodes of a one-meter grid, so that a ray meets it in closed form. */
class Terrain {
 public:
  /** A sine wave of the ground: amplitude and length in meters, direction and phase in radians. */
  struct Wave {
    double amplitude, length, direction, phase;
  };
  static constexpr double kCell = 1.0;  // meters between nodes

  /** \param halfExtent The ground reaches from -halfExtent to +halfExtent in x and y, meters.
   * \throw std::invalid_argument halfExtent is not a whole number of meters from 1 to 1000, or a
   *   wave is not finite or shorter than 8 m (the grid would not follow it). */
  Terrain(int halfExtent, const std::vector<Wave>& waves);

  double halfExtent() const { return m_halfExtent; }
  bool contains(double x, double y) const {
    return std::abs(x) <= m_halfExtent && std::abs(y) <= m_halfExtent;
  }

  /** Meters; beyond the edge, the height of the nearest point of the edge. */
  double height(double x, double y) const;
  /** Unit normal of the ground's slope over half a meter around (x, y). */
  Eigen::Vector3d normal(double x, double y) const;

  /** Cells are numbered 0..cells()-1 in x and in y from the corner of least coordinates. */
  int cells() const { return 2 * static_cast<int>(m_halfExtent); }
  /** Greatest height in a cell. */
  double cellTop(int cx, int cy) const;
  double lowest() const { return m_lowest; }
  double highest() const { return m_highest; }

  /** Where within [from, to] a ray first is on or below the ground of one cell, as if the cell's
   * surface went on beyond it. \return the range. */
  std::optional<double> enter(int cx, int cy, const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction, double from, double to) const;

 private:
  double node(int nx, int ny) const { return m_nodes[ny * m_width + nx]; }

  double m_halfExtent;
  int m_width;  // nodes in a row
  std::vector<double> m_nodes;
  double m_lowest, m_highest;
};

}  // namespace synthetic_world
