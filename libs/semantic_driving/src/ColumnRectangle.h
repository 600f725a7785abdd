#pragma once
#include <semantic_planning/ground/Ground.h>

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
  /** f(column) for those at the rim. */
  template <class F>
  void forRim(F f) const {
    for (int x = m_low.x; x <= m_high.x; ++x) f(Column{x, m_low.y}), f(Column{x, m_high.y});
    for (int y = m_low.y + 1; y < m_high.y; ++y) f(Column{m_low.x, y}), f(Column{m_high.x, y});
  }

 private:
  Column m_low, m_high;
  int m_width;
};

/** What ground is known within a radius (meters) around a column, along x and y, and a margin of
 * the unknown around that. */
ColumnRectangle knownAround(const semantic_planning::Ground& ground,
                            semantic_planning::Column center, double radius);

}  // namespace semantic_driving
