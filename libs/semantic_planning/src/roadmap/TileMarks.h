#pragma once
#include <semantic_planning/roadmap/PosePair.h>

#include <vector>

#include "ground/ColumnGrid.h"

namespace semantic_planning {

/** The columns within a distance of a point, along the axes; meters. */
struct Square {
  double x, y, distance;
};

/** Where columns lie that an edge's outcome may depend on: a curve stays within half its length of
 * the middle between its ends. \param length of the curve, meters */
inline Square squareAround(const PosePair& ends, double length, const CollisionChecker& checker) {
  const auto &a = ends.first.pose, &b = ends.second.pose;
  return {(a.x + b.x) / 2, (a.y + b.y) / 2, length / 2 + checker.reach()};
}

/** Whether f(tile) answers true for any tile that meets the square. */
template <class F>
bool anyTileIn(const Ground& ground, const Square& s, F f) {
  const Column low = tileOf(ground.columnAt(s.x - s.distance, s.y - s.distance));
  const Column high = tileOf(ground.columnAt(s.x + s.distance, s.y + s.distance));
  for (int ty = low.y; ty <= high.y; ++ty)
    for (int tx = low.x; tx <= high.x; ++tx)
      if (f(Column{tx, ty})) return true;
  return false;
}

/** Some tiles, to be asked for often. */
class TileMarks {
 public:
  TileMarks(const Ground& ground, const std::vector<Column>& tiles) : m_ground(ground) {
    for (const Column& tile : tiles) m_marks.at(tile) = true;
  }

  /** Whether one of them meets the square. */
  bool anyIn(const Square& square) const {
    return anyTileIn(m_ground, square, [this](Column tile) {
      const char* mark = m_marks.find(tile);
      return mark && *mark;
    });
  }

 private:
  const Ground& m_ground;
  ColumnGrid<char> m_marks;
};

}  // namespace semantic_planning
