#pragma once
#include <semantic_planning/ground/Ground.h>
#include <semantic_planning/planner/SemanticPlanner.h>
#include <semantic_planning/vehicle/Footprint.h>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace semantic_driving {

/** The columns from one corner to another, numbered row by row. */
class ColumnRectangle {
 public:
  using Column = semantic_planning::Column;

  ColumnRectangle(Column low, Column high)
      : m_low(low), m_high(high), m_width(high.x - low.x + 1) {}
  /** A square. */
  static ColumnRectangle around(Column center, int reach) {
    return {{center.x - reach, center.y - reach}, {center.x + reach, center.y + reach}};
  }

  Column low() const { return m_low; }
  Column high() const { return m_high; }
  int width() const { return m_width; }
  std::size_t size() const {
    return static_cast<std::size_t>(m_width) * static_cast<std::size_t>(m_high.y - m_low.y + 1);
  }
  bool contains(Column c) const {
    return c.x >= m_low.x && c.x <= m_high.x && c.y >= m_low.y && c.y <= m_high.y;
  }
  bool isAtRim(Column c) const {
    return c.x == m_low.x || c.x == m_high.x || c.y == m_low.y || c.y == m_high.y;
  }
  /** Whether a straight line leads from a column outside to one at the rim without crossing the
   * rectangle. */
  bool faces(Column rim, Column outside) const {
    return (rim.x == m_low.x && outside.x < m_low.x) ||
           (rim.x == m_high.x && outside.x > m_high.x) ||
           (rim.y == m_low.y && outside.y < m_low.y) || (rim.y == m_high.y && outside.y > m_high.y);
  }
  std::size_t indexOf(Column c) const {
    return static_cast<std::size_t>(c.y - m_low.y) * m_width + (c.x - m_low.x);
  }
  Column columnOf(std::size_t i) const {
    return {m_low.x + static_cast<int>(i) % m_width, m_low.y + static_cast<int>(i) / m_width};
  }

 private:
  Column m_low, m_high;
  int m_width;
};

/** What ground is known within a radius (meters) around a column, along x and y, and a margin of
 * the unknown around that. */
ColumnRectangle knownAround(const semantic_planning::Ground& ground,
                            semantic_planning::Column center, double radius);

/** All around a column. */
constexpr std::array<semantic_planning::Column, 8> kNeighbors = {
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

/** Length of a step to one of them, in columns. */
inline double lengthOf(semantic_planning::Column step) {
  constexpr double kDiagonal = 1.4142135623730951;
  return step.x != 0 && step.y != 0 ? kDiagonal : 1;
}

/** Where a vehicle gets over known ground, and the least way there: Dijkstra's search over the
 * columns around it. The footprint fits from column to column, headed there or away from there; how
 * it turns in between is not asked. */
class GroundFlood {
 public:
  /** \param z key of the ground's height below the vehicle \param radius how far, meters */
  GroundFlood(const semantic_planning::SemanticPlanner& planner, const mrpt::math::TPose2D& from,
              int z, double radius);

  struct Place {
    double cost = std::numeric_limits<double>::infinity();
    semantic_planning::Column from;
    colored_graph::Rank rank = 0;
    std::uint16_t z = 0;
    bool done = false;
  };

  /** f(column, place) for all columns where the vehicle can get. */
  template <class F>
  void forEach(F f) const {
    for (std::size_t i = 0; i < m_places.size(); ++i)
      if (m_places[i].done) f(m_columns.columnOf(i), m_places[i]);
  }
  /** \param c in columns() */
  const Place& at(semantic_planning::Column c) const { return m_places[m_columns.indexOf(c)]; }

  /** Where there may be any. */
  const ColumnRectangle& columns() const { return m_columns; }
  /** For each of columns(). */
  std::vector<bool> reached() const;

 private:
  using Open = std::pair<double, std::size_t>;

  /** \param distance from where the vehicle stands, meters */
  bool isNear(semantic_planning::Column c, double distance) const;
  bool isFree(const semantic_planning::Surface& surface, double radius) const {
    return m_ground.hasClearance(surface, radius);
  }
  bool fits(semantic_planning::Column c, const semantic_planning::Surface& surface,
            const semantic_planning::Column& direction) const;
  bool fitsHeaded(semantic_planning::Column c, int z, double x, double y) const;
  void offer(const Place& place, semantic_planning::Column c);
  void flood(int z);
  double turningOf(semantic_planning::Column c, const semantic_planning::Column& d) const;
  void expand(semantic_planning::Column c, const Place& place);

  const semantic_planning::SemanticPlanner& m_planner;
  const semantic_planning::Ground& m_ground;
  semantic_planning::Column m_center;
  ColumnRectangle m_columns;
  mrpt::math::TPoint2D m_ahead;  ///< where the vehicle heads
  std::vector<semantic_planning::Disc> m_discs;
  double m_inner, m_outer = 0;  ///< radii about the origin: in the footprint, around it; meters
  std::vector<Place> m_places;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> m_open;
};

}  // namespace semantic_driving
