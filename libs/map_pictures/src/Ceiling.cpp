#include <algorithm>
#include <unordered_map>

#include "MapCells.h"

namespace map_pictures {
namespace {

/** Room below a ceiling, m. */
constexpr float kRoom = 1.2f;
/** Ceilings are that flat: most of it within these, m. */
constexpr float kFlat = 0.4f;

/** The two uppermost surfaces of one column, m: centers of their highest cells. */
struct Column {
  float top = -std::numeric_limits<float>::infinity(), next = top;

  void add(float z) {
    if (z > top) std::swap(z, top);
    if (top - z > kRoom) next = std::max(next, z);
  }
};

/** Heights of what hangs over something with room between. */
std::vector<float> hangingSurfaces(const std::vector<MapCell>& cells, std::size_t& columns) {
  std::unordered_map<std::uint32_t, Column> byPlace;
  for (const MapCell& cell : cells)
    byPlace[std::uint32_t(cell.key[0]) << 16 | cell.key[1]].add(cell.center.z());
  columns = byPlace.size();
  std::vector<float> heights;
  for (const auto& [place, column] : byPlace)
    if (column.next > -std::numeric_limits<float>::infinity()) heights.push_back(column.top);
  return heights;
}

/** The lowest height at which a flat surface of a room's size begins; heights are sorted. */
float lowestFlatSurface(const std::vector<float>& heights, std::size_t size) {
  for (std::size_t i = 0; i + size <= heights.size(); ++i)
    if (heights[i + size - 1] - heights[i] < kFlat / 2) return heights[i];
  return heights.front();
}

}  // namespace

double heightUnderCeiling(const std::vector<MapCell>& cells) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::size_t columns = 0;
  std::vector<float> heights = hangingSurfaces(cells, columns);
  if (columns == 0 || heights.size() * 2 < columns) return kNone;
  std::sort(heights.begin(), heights.end());
  const float lower = heights[heights.size() / 5], upper = heights[heights.size() * 4 / 5];
  if (upper - lower > kFlat) return kNone;
  return lowestFlatSurface(heights, std::max<std::size_t>(1, columns / 20)) - kFlat / 2;
}

}  // namespace map_pictures
