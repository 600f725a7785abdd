#pragma once
#include <semantic_planning/ground/Surface.h>

#include <algorithm>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace semantic_planning {

/** In the octree's order. So each tile of a map in a folder comes in a few times at most, and not
 * once for each row of columns. */
inline std::vector<Column> inMortonOrder(std::vector<Column> tiles) {
  const auto isBefore = [](const Column& l, const Column& r) {
    const unsigned x = static_cast<unsigned>(l.x ^ r.x), y = static_cast<unsigned>(l.y ^ r.y);
    const bool xIsHigher = y < x && y < (x ^ y);  // the highest bit in which they differ is x's
    return xIsHigher ? l.x < r.x : l.y < r.y;
  };
  std::sort(tiles.begin(), tiles.end(), isBefore);
  return tiles;
}

/** Tiles that are set, each with a T of its own. Their rectangle grows by more than needed, and so
 * seldom. Of what is not set a pointer is all that is taken: ground along a way is a small part of
 * its rectangle. A copy shares the tiles until one of the two is about to change. */
template <class T>
class ColumnGrid {
 public:
  /** Null: it is not set. */
  const T* find(Column tile) const {
    const std::int32_t number = numberOf(tile);
    return number == kNoTile ? nullptr : at(number);
  }
  T* find(Column tile) {
    const std::int32_t number = numberOf(tile);
    return number == kNoTile ? nullptr : own(m_tiles[static_cast<std::size_t>(number)]);
  }
  /** The rectangle's tiles are numbered row by row; kNoTile: it is outside. */
  static constexpr std::int32_t kNoTile = -1;
  std::size_t size() const { return m_tiles.size(); }
  std::int32_t numberOf(Column tile) const {
    const int x = tile.x - m_first.x, y = tile.y - m_first.y;
    const auto isWithin = [](int at, int size) {
      return static_cast<unsigned>(at) < static_cast<unsigned>(size);
    };
    return isWithin(x, m_width) && isWithin(y, m_height) ? y * m_width + x : kNoTile;
  }
  Column tileOfNumber(std::int32_t number) const {
    return {m_first.x + number % m_width, m_first.y + number / m_width};
  }
  const T* at(std::int32_t number) const { return m_tiles[static_cast<std::size_t>(number)].get(); }
  /** Sets it, if it is not. */
  T& at(Column tile) {
    std::shared_ptr<T>& at = placeOf(tile);
    if (!at) at = std::make_shared<T>();
    return *own(at);
  }

  /** f(tile, const T&) for all that are set, row by row. */
  template <class F>
  void forEach(F f) const {
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(size()); ++i)
      if (const T* const tile = at(i)) f(tileOfNumber(i), *tile);
  }

 private:
  static T* own(std::shared_ptr<T>& tile) {
    if (tile.use_count() > 1) tile = std::make_shared<T>(*tile);
    return tile.get();
  }

  /** Makes a range of `size` from `first` on hold `at`. */
  static void stretch(int at, int& first, int& size) {
    if (size == 0) first = at;
    const int spare = size / 4, end = first + size;
    const int low = at < first ? at - spare : first;
    size = (at < end ? end : at + 1 + spare) - low;
    first = low;
  }

  std::shared_ptr<T>& placeOf(Column tile) {
    if (numberOf(tile) == kNoTile) growTo(tile);
    return m_tiles[static_cast<std::size_t>(numberOf(tile))];
  }

  void growTo(Column tile) {
    ColumnGrid grown;
    grown.m_first = m_first;
    grown.m_width = m_width;
    grown.m_height = m_height;
    stretch(tile.x, grown.m_first.x, grown.m_width);
    stretch(tile.y, grown.m_first.y, grown.m_height);
    grown.m_tiles.resize(static_cast<std::size_t>(grown.m_width) * grown.m_height);
    for (int y = 0; y < m_height; ++y)
      for (int x = 0; x < m_width; ++x)
        grown.placeOf({m_first.x + x, m_first.y + y}) =
            std::move(m_tiles[static_cast<std::size_t>(y) * m_width + x]);
    *this = std::move(grown);
  }

  Column m_first;
  int m_width = 0, m_height = 0;
  std::vector<std::shared_ptr<T>> m_tiles;
};

/** The smallest rectangle with some columns of one tile. */
struct ColumnBox {
  Column low{INT_MAX, INT_MAX}, high{INT_MIN, INT_MIN};  ///< both inside

  bool empty() const { return low.x > high.x; }
  Column tile() const { return tileOf(low); }
  bool overlaps(const ColumnBox& o) const {
    return low.x <= o.high.x && high.x >= o.low.x && low.y <= o.high.y && high.y >= o.low.y;
  }
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

/** f(tile) for the tiles that boxes with a margin overlap; for some more than once. */
template <class F>
void forTilesWithin(const std::vector<ColumnBox>& boxes, const Margin& margin, F f) {
  for (const ColumnBox& box : boxes) {
    const Column low = tileOf({box.low.x - margin.left, box.low.y - margin.down});
    const Column high = tileOf({box.high.x + margin.right, box.high.y + margin.up});
    for (int x = low.x; x <= high.x; ++x)
      for (int y = low.y; y <= high.y; ++y) f(Column{x, y});
  }
}

/** The tiles that forTilesWithin() visits, sorted. */
inline std::vector<Column> tilesWithin(const std::vector<ColumnBox>& boxes, const Margin& margin) {
  std::vector<Column> tiles;
  forTilesWithin(boxes, margin, [&](Column tile) { tiles.push_back(tile); });
  sortOut(tiles);
  return tiles;
}

inline std::vector<Column> tilesWithin(const std::vector<ColumnBox>& boxes, int margin) {
  return tilesWithin(boxes, {margin, margin, margin, margin});
}

}  // namespace semantic_planning
