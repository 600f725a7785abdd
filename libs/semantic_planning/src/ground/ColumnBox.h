#pragma once

#include <algorithm>
#include <climits>
#include <vector>
#include "ColumnGrid.h"

namespace semantic_planning {

/** The smallest rectangle with some columns of one tile. */
struct ColumnBox {
  Column low{INT_MAX, INT_MAX}, high{INT_MIN, INT_MIN};  ///< both inside

  bool empty() const { return low.x > high.x; }
  Column tile() const { return tileOf(low); }
  void add(Column c) { add({c, c}); }
  void add(const ColumnBox& o) {
    low = {std::min(low.x, o.low.x), std::min(low.y, o.low.y)};
    high = {std::max(high.x, o.high.x), std::max(high.y, o.high.y)};
  }
};

/** How far columns matter, on each side. */
struct Margin {
  int left, right, down, up;
};

inline void sortOut(std::vector<Column>& tiles) {
  std::sort(tiles.begin(), tiles.end());
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
}

/** The tiles that boxes with a margin overlap, sorted. */
inline std::vector<Column> tilesWithin(const std::vector<ColumnBox>& boxes, const Margin& margin) {
  std::vector<Column> tiles;
  for (const ColumnBox& box : boxes) {
    const Column low = tileOf({box.low.x - margin.left, box.low.y - margin.down});
    const Column high = tileOf({box.high.x + margin.right, box.high.y + margin.up});
    for (int x = low.x; x <= high.x; ++x)
      for (int y = low.y; y <= high.y; ++y) tiles.push_back({x, y});
  }
  sortOut(tiles);
  return tiles;
}

inline std::vector<Column> tilesWithin(const std::vector<ColumnBox>& boxes, int margin) {
  return tilesWithin(boxes, {margin, margin, margin, margin});
}

}  // namespace semantic_planning
