#pragma once
#include <semantic_planning/Ground.h>

#include <vector>

namespace semantic_planning {

/** Some tiles, to be asked for often. */
class TileMarks {
 public:
  TileMarks(const Ground& ground, const std::vector<Column>& tiles) : m_ground(ground) {
    for (const Column& tile : tiles) m_marks.at(tile) = true;
  }

  /** Whether one of them comes within a distance (meters, along the axes) of a point. */
  bool near(double x, double y, double distance) const {
    const Column low = tileOf(m_ground.columnAt(x - distance, y - distance));
    const Column high = tileOf(m_ground.columnAt(x + distance, y + distance));
    for (int ty = low.y; ty <= high.y; ++ty)
      for (int tx = low.x; tx <= high.x; ++tx)
        if (const char* mark = m_marks.find({tx, ty}); mark && *mark) return true;
    return false;
  }

 private:
  const Ground& m_ground;
  TileGrid<char> m_marks;
};

}  // namespace semantic_planning
