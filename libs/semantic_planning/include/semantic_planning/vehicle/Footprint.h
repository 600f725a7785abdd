#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

namespace semantic_planning {

/** A disc that covers a part of a footprint. */
struct Disc {
  double x = 0, y = 0;  ///< center in the vehicle's frame, meters
  double radius = 0;    ///< meters
};

/** A vehicle's outline on the ground: a convex polygon in the vehicle's frame (x ahead, y to the
 * left, meters). Convex, because discs, margins and distances are those of convex shapes: give the
 * hull of any other one. The vehicle's origin may lie outside. */
class Footprint {
 public:
  /** A robot of 0.8 m x 0.6 m, its origin 0.25 m before its back. */
  Footprint() : Footprint(rectangle(-0.25, 0.55, 0.6)) {}
  /** \param corners in order, either way round. \throw std::invalid_argument naming the corner:
   * fewer than three, not finite, two at one place, sides that cross or turn back, not convex. */
  Footprint(std::vector<Eigen::Vector2d> corners);  // NOLINT: a list of corners is an outline
  /** From `back` (negative) to `front`, `width` wide; meters. */
  static Footprint rectangle(double back, double front, double width);

  /** Counterclockwise. */
  const std::vector<Eigen::Vector2d>& corners() const { return m_corners; }
  auto begin() const { return m_corners.begin(); }
  auto end() const { return m_corners.end(); }
  std::size_t size() const { return m_corners.size(); }
  const Eigen::Vector2d& operator[](std::size_t i) const { return m_corners[i]; }

  /** Every side moved outwards by a margin, meters; corners stay corners, so that they move by
   * more. \throw std::invalid_argument the margin is negative or not finite. */
  Footprint inflated(double margin) const;
  /** From a point, meters; 0 within. */
  double distance(const Eigen::Vector2d& point) const;
  /** The radius of the largest disc around the origin that the footprint covers, meters; 0 if the
   * origin is outside. */
  double inscribedRadius() const;
  /** Discs that together cover the footprint: a vehicle whose discs are free is free. Beside long
   * vehicles they stick out by at most a tenth of the width. \param most where one disc would
   * stick out by more than this at the front or back, there are two beside each other */
  std::vector<Disc> coveringDiscs(double most = std::numeric_limits<double>::infinity()) const;

 private:
  /** From a corner to the next one. */
  Eigen::Vector2d side(std::size_t i) const {
    return m_corners[(i + 1) % m_corners.size()] - m_corners[i];
  }
  void check() const;

  std::vector<Eigen::Vector2d> m_corners;
};

}  // namespace semantic_planning
