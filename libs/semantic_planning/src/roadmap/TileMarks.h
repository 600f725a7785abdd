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

/** Some tiles, to be asked for often. */
class TileMarks {
 public:
  TileMarks(const Ground& ground, const std::vector<Column>& tiles) : m_ground(ground) {
    for (const Column& tile : tiles) m_marks.at(tile) = true;
  }

  /** Whether one of them meets the square. */
  bool anyIn(const Square& square) const {
    const Column low =
        tileOf(m_ground.columnAt(square.x - square.distance, square.y - square.distance));
    const Column high =
        tileOf(m_ground.columnAt(square.x + square.distance, square.y + square.distance));
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x)
        if (m_marks.find({x, y})) return true;
    return false;
  }

 private:
  const Ground& m_ground;
  ColumnGrid<char> m_marks;
};

}  // namespace semantic_planning
