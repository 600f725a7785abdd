#pragma once

#include <vector>
#include "ColumnGrid.h"

namespace semantic_planning {

/** The tiles around one tile, to look columns up often. Valid while the grid's rectangle is. */
template <class T>
class TileWindow {
 public:
  /** \param reach columns outside of the tile that are asked for, at most */
  TileWindow(const ColumnGrid<T>& grid, Column tile, int reach) {
    static const T none{};
    const int ring = (reach + kTileEdge - 1) / kTileEdge;
    m_first = {tile.x - ring, tile.y - ring};
    m_width = 2 * ring + 1;
    for (int y = 0; y < m_width; ++y)
      for (int x = 0; x < m_width; ++x) {
        const T* found = grid.find({m_first.x + x, m_first.y + y});
        m_tiles.push_back(found ? found : &none);
      }
  }

  /** The tile that holds a column; an empty one where the grid has none. */
  const T& around(Column c) const {
    const Column tile = tileOf(c);
    return *m_tiles[(tile.y - m_first.y) * m_width + tile.x - m_first.x];
  }

 private:
  Column m_first;
  int m_width;
  std::vector<const T*> m_tiles;
};

}  // namespace semantic_planning
