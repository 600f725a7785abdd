#pragma once
#include <Eigen/Core>
#include <vector>

namespace synthetic_world {

/** A line through the plane made of straight pieces and arcs that meet without a kink: the middle
 * of a road, the way of a robot. Parametrized by the length from its start, in meters. */
class Curve {
 public:
  /** Straight lines between the corners, each corner rounded.
   * \param radius Of the roundings, meters; less where an edge is too short for it.
   * \param closed The last corner leads back to the first.
   * \throw std::invalid_argument fewer than two corners (three if closed), two equal neighbors,
   *   a corner that turns back on itself, or a radius that is not positive. */
  Curve(const std::vector<Eigen::Vector2d>& corners, double radius, bool closed = false);

  double length() const { return m_length; }
  bool closed() const { return m_closed; }

  /** Point at length s; s wraps around on a closed curve and is clamped on an open one. */
  Eigen::Vector2d at(double s) const;
  /** Direction of travel at s, radians counterclockwise from x. */
  double heading(double s) const;
  /** One over the radius at s, positive where it turns left. */
  double curvature(double s) const;
  /** Point at s, moved by `left` meters to the left of the direction of travel. */
  Eigen::Vector2d beside(double s, double left) const;

  /** The parallel curve at `left` meters.
   * \throw std::invalid_argument the arcs of this curve are too narrow for it. */
  Curve parallel(double left) const;

 private:
  struct Piece {
    Eigen::Vector2d start;
    double heading, length, curvature, from;  // from: length of all pieces before this one
  };
  Curve() = default;
  void append(const Eigen::Vector2d& start, double heading, double length, double curvature);
  void build(const std::vector<Eigen::Vector2d>& corners, double radius);
  double wrapped(double s) const;
  const Piece& pieceAt(double s) const;

  std::vector<Piece> m_pieces;
  double m_length = 0;
  bool m_closed = false;
};

}  // namespace synthetic_world
