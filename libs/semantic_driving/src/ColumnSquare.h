#pragma once
#include <semantic_planning/ground/Column.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace semantic_driving {

/** The columns at most `reach` from a column, along x and along y, numbered. */
class ColumnSquare {
 public:
  ColumnSquare(semantic_planning::Column center, int reach)
      : m_center(center), m_reach(reach), m_edge(2 * reach + 1) {}

  int reach() const { return m_reach; }
  std::size_t size() const { return static_cast<std::size_t>(m_edge) * m_edge; }
  bool contains(semantic_planning::Column c) const { return far(c) <= m_reach; }
  bool isAtRim(semantic_planning::Column c) const { return far(c) == m_reach; }
  std::size_t indexOf(semantic_planning::Column c) const {
    return static_cast<std::size_t>(c.y - m_center.y + m_reach) * m_edge +
           (c.x - m_center.x + m_reach);
  }
  semantic_planning::Column columnOf(std::size_t i) const {
    return {m_center.x - m_reach + static_cast<int>(i) % m_edge,
            m_center.y - m_reach + static_cast<int>(i) / m_edge};
  }

 private:
  /** How far a column is, which may be anywhere, in columns along x or y. */
  std::int64_t far(semantic_planning::Column c) const {
    return std::max(std::abs(std::int64_t{c.x} - m_center.x),
                    std::abs(std::int64_t{c.y} - m_center.y));
  }

  semantic_planning::Column m_center;
  int m_reach, m_edge;
};

}  // namespace semantic_driving
