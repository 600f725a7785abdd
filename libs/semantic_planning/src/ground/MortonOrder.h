#pragma once
#include <semantic_planning/ground/Column.h>

#include <algorithm>
#include <vector>

namespace semantic_planning {

/** In the order in which the octree has them: of a map in a folder of tiles, each tile then comes
 * in a few times at most, and not once for each row of columns. */
inline std::vector<Column> inMortonOrder(std::vector<Column> tiles) {
  const auto isBefore = [](const Column& l, const Column& r) {
    const unsigned x = static_cast<unsigned>(l.x ^ r.x), y = static_cast<unsigned>(l.y ^ r.y);
    const bool xIsHigher = y < x && y < (x ^ y);  // the highest bit in which they differ is x's
    return xIsHigher ? l.x < r.x : l.y < r.y;
  };
  std::sort(tiles.begin(), tiles.end(), isBefore);
  return tiles;
}

}  // namespace semantic_planning
