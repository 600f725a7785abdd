#pragma once
#include <semantic_planning/ground/Column.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace semantic_planning {

/** One T for every tile within a rectangle, which grows as tiles are set: by more than needed, so
 * that it seldom does. */
template <class T>
class ColumnGrid {
 public:
  /** Null outside of the rectangle. */
  const T* find(Column tile) const {
    const int x = tile.x - m_first.x, y = tile.y - m_first.y;
    if (x < 0 || y < 0 || x >= m_width || y >= m_height) return nullptr;
    return &m_tiles[static_cast<std::size_t>(y) * m_width + x];
  }
  T* find(Column tile) { return const_cast<T*>(static_cast<const ColumnGrid*>(this)->find(tile)); }
  /** Makes the rectangle, which has nothing in it yet, reach from one tile to another: no more
   * memory is taken than that needs. */
  void cover(Column low, Column high) {
    m_first = low;
    m_width = high.x - low.x + 1;
    m_height = high.y - low.y + 1;
    m_tiles = std::vector<T>(static_cast<std::size_t>(m_width) * m_height);
  }
  T& at(Column tile) {
    if (!find(tile)) growTo(tile);
    return *find(tile);
  }

  /** f(tile, T&) for the tiles from low to high that are in the rectangle. */
  template <class F>
  void forEachIn(Column low, Column high, F f) {
    for (int y = std::max(low.y, m_first.y); y <= std::min(high.y, m_first.y + m_height - 1); ++y)
      for (int x = std::max(low.x, m_first.x); x <= std::min(high.x, m_first.x + m_width - 1); ++x)
        f(Column{x, y}, *find({x, y}));
  }
  /** f(tile, T&) for all tiles of the rectangle. */
  template <class F>
  void forEach(F f) {
    forEachIn(m_first, {m_first.x + m_width - 1, m_first.y + m_height - 1}, f);
  }
  template <class F>
  void forEach(F f) const {
    const_cast<ColumnGrid*>(this)->forEach([&](Column tile, const T& t) { f(tile, t); });
  }

 private:
  /** Makes a range of `size` from `first` on hold `at`. */
  static void stretch(int at, int& first, int& size) {
    if (size == 0) first = at;
    const int spare = size / 4, end = first + size;
    const int low = at < first ? at - spare : first;
    size = (at < end ? end : at + 1 + spare) - low;
    first = low;
  }

  void growTo(Column tile) {
    ColumnGrid grown;
    grown.m_first = m_first;
    grown.m_width = m_width;
    grown.m_height = m_height;
    stretch(tile.x, grown.m_first.x, grown.m_width);
    stretch(tile.y, grown.m_first.y, grown.m_height);
    grown.m_tiles.resize(static_cast<std::size_t>(grown.m_width) * grown.m_height);
    forEach([&](Column t, T& value) { grown.at(t) = std::move(value); });
    *this = std::move(grown);
  }

  Column m_first;
  int m_width = 0, m_height = 0;
  std::vector<T> m_tiles;
};

}  // namespace semantic_planning
