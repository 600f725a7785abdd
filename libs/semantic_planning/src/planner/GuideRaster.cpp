#include "GuideRaster.h"

#include <algorithm>
#include <cstdlib>

#include "ground/SurfaceTile.h"

namespace semantic_planning {

GuideRaster::GuideRaster(const Ground& ground, const PlanningRegion& region) {
  const std::vector<Column> tiles = tilesIn(region, ground);
  if (tiles.empty()) return;
  Column low = tiles.front(), high = low;
  for (const Column& tile : tiles) {
    low = {std::min(low.x, tile.x), std::min(low.y, tile.y)};
    high = {std::max(high.x, tile.x), std::max(high.y, tile.y)};
  }
  m_low = firstColumnOf(low);
  m_width = (high.x - low.x + 1) * kTileEdge;
  m_height = (high.y - low.y + 1) * kTileEdge;
  m_first.assign(static_cast<std::size_t>(m_width) * static_cast<std::size_t>(m_height), kNone);
  m_cells.reserve(tiles.size() * kTileColumns);
  for (const Column& tile : tiles) add(tile, ground);
}

void GuideRaster::add(Column tile, const Ground& ground) {
  forColumnsOf(tile, [&](Column c) {
    const int first = size();
    for (const Surface& s : ground.surfaces(c))
      if (s.drivable) m_cells.push_back({c, s.z, s.classId, s.clearance2});
    if (size() > first)
      m_first[static_cast<std::size_t>((c.y - m_low.y) * m_width + c.x - m_low.x)] = first;
  });
}

int GuideRaster::near(Column c, int z, int tolerance) const {
  const int x = c.x - m_low.x, y = c.y - m_low.y;
  if (x < 0 || y < 0 || x >= m_width || y >= m_height) return kNone;
  int best = kNone, least = tolerance + 1;
  const int first = m_first[static_cast<std::size_t>(y * m_width + x)];
  if (first == kNone) return kNone;
  for (int i = first; i < size() && m_cells[static_cast<std::size_t>(i)].column == c; ++i) {
    const int off = std::abs(m_cells[static_cast<std::size_t>(i)].z - z);
    if (off < least) best = i, least = off;
  }
  return best;
}

}  // namespace semantic_planning
