#pragma once
#include <synthetic_world/Solids.h>
#include <Eigen/Core>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace synthetic_world {

/** The hills: a square of ground around the origin. Its height is interpolated bilinearly between
 * the nodes of a one-meter grid, so that a ray meets it in closed form. */
class Terrain {
 public:
  /** A sine wave of the ground: amplitude and length in meters, direction and phase in radians. */
  struct Wave {
    double amplitude, length, direction, phase;
  };
  static constexpr double kCell = 1.0;  // meters between nodes

  /** \param halfExtent The ground reaches from -halfExtent to +halfExtent in x and y: 1 to 1000 m
   * \param waves finite, 8 m or longer (the grid would not follow shorter ones) */
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
  double m_highest;
};

/** A line of straight pieces and arcs that meet without a kink: the middle of a road, the way of a
 * robot. Parametrized by the length from its start, in meters. */
class Curve {
 public:
  /** Straight lines between the corners, each corner rounded.
   * \param radius Of the roundings, meters; less where an edge is too short for it.
   * \param corners Two or more (three if closed), none equal to the next, none that turns back on
   *   itself. \param closed The last corner leads back to the first. */
  Curve(const std::vector<Eigen::Vector2d>& corners, double radius, bool closed = false);

  double length() const { return m_length; }

  /** Point at length s; s wraps around on a closed curve and is clamped on an open one. */
  Eigen::Vector2d at(double s) const;
  /** Direction of travel at s, radians counterclockwise from x. */
  double heading(double s) const;
  /** One over the radius at s, positive where it turns left. */
  double curvature(double s) const;
  /** Point at s, moved by `left` meters to the left of the direction of travel. */
  Eigen::Vector2d beside(double s, double left) const;

  /** The parallel curve at `left` meters; the arcs of this curve are wide enough for it. */
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

/** Which solids stand in which cell of the terrain. */
class SolidIndex {
 public:
  SolidIndex(const Terrain& terrain, const Solids& solids);

  /** Numbers of the solids that reach into a cell. */
  const std::vector<std::uint32_t>& solids(int cx, int cy) const { return at(cx, cy).solids; }
  /** Nothing in the cell, ground included, is higher than this. */
  double top(int cx, int cy) const { return at(cx, cy).top; }
  /** Nothing in the world is higher than this. */
  double highest() const { return m_highest; }
  /** Cell of a coordinate, the nearest one for a coordinate beyond the edge. */
  int cellOf(double coordinate) const;

 private:
  struct Cell {
    double top;
    std::vector<std::uint32_t> solids;
  };
  const Cell& at(int cx, int cy) const { return m_cells[cy * m_width + cx]; }
  void insert(const Solid& solid, std::uint32_t number);

  double m_halfExtent;
  int m_width;
  double m_highest;
  std::vector<Cell> m_cells;
};

/** What a ray meets first. */
struct Hit {
  double range = 0;  // meters
  Eigen::Vector3d point, normal;
  Material material;
};

/** The truth about a point. */
struct PointTruth {
  enum class State { Free, Surface, Inside, Underground };
  State state = State::Free;
  ClassId id = kNoClass;  // of the nearest surface; kNoClass where free

  bool operator==(const PointTruth& o) const { return state == o.state && id == o.id; }
};

/** Outline and heights of a robot. */
struct Footprint {
  Polygon outline = rectangle({0, 0}, 0, 0.9, 0.6);  // robot frame, meters
  double clearance = 0.1;                            // m; lower things are driven over
  double height = 1.2;                               // m
};

/** A place: ground with classes, and solids that stand on it. Frame: x, y, z up, meters.
 *
 * Queries do not change the world and may run in parallel. */
class World {
 public:
  World(Terrain terrain, GroundCover cover, Solids solids);

  const Terrain& terrain() const { return m_terrain; }
  const Solids& solids() const { return m_solids; }
  double halfExtent() const { return m_terrain.halfExtent(); }

  double groundHeight(double x, double y) const { return m_terrain.height(x, y); }
  ClassId groundClass(double x, double y) const { return m_cover.at(x, y); }
  /** Pose of a robot that stands on the ground: its x axis ahead, its z axis along the normal. */
  Eigen::Isometry3d poseOnGround(double x, double y, double yaw) const;

  /** Things that come, go and move, in addition to those of the scene (a person, a roadblock).
   * Replaces those set before. */
  void setMovables(Solids movables) { m_movables = std::move(movables); }

  /** What is at a point.
   *
   * Surface: within `tolerance` meters of the ground or of a solid's surface. Inside: deeper in a
   * solid; Underground: deeper in the ground. The class is that of the nearest surface. Near the
   * edges of a solid the tolerance reaches a little further, to the corner of its offset faces. */
  PointTruth at(const Eigen::Vector3d& p, double tolerance = 0.01) const;

  /** The nearest surface along a ray.
   * \param direction Unit length.
   * \param maxRange Meters.
   * A ray that starts in a solid or below the ground hits at range 0. */
  std::optional<Hit> castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double maxRange) const;

  /** Distance in meters, measured in the plane, from a robot at (x, y, yaw) to the nearest solid in
   * its heights; 0 is a collision. Not more than `limit`. */
  double clearance(const Footprint& footprint, double x, double y, double yaw,
                   double limit = 5.0) const;
  bool isFree(const Footprint& footprint, double x, double y, double yaw) const {
    return clearance(footprint, x, y, yaw, 0.01) > 0;
  }

 private:
  Terrain m_terrain;
  GroundCover m_cover;
  Solids m_solids, m_movables;
  SolidIndex m_index;
};

}  // namespace synthetic_world
