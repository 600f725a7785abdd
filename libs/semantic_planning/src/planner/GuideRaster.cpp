#include "GuideRaster.h"

#include <algorithm>
#include <cstdlib>

#include "ground/SurfaceTile.h"

namespace semantic_planning {

GuideRaster::GuideRaster(const Ground& ground, const PlanningRegion& region) {
  const std::vector<Column> tiles = tilesIn(region, ground);
  m_cells.reserve(tiles.size() * kTileColumns);
  for (const Column& tile : tiles) add(tile, ground);
}

void GuideRaster::add(Column tile, const Ground& ground) {
  auto& firstOf = m_first.at(tile);
  forColumnsOf(tile, [&](Column c) {
    const int first = size();
    for (const Surface& s : ground.surfaces(c))
      if (s.drivable) m_cells.push_back({c, s.z, s.classId, s.clearance2});
    firstOf[static_cast<std::size_t>(indexInTile(c))] = size() > first ? first : kNone;
  });
}

int GuideRaster::near(Column c, int z, int tolerance) const {
  const auto* const tile = m_first.find(tileOf(c));
  if (!tile) return kNone;
  int best = kNone, least = tolerance + 1;
  const int first = (*tile)[static_cast<std::size_t>(indexInTile(c))];
  if (first == kNone) return kNone;
  for (int i = first; i < size() && m_cells[static_cast<std::size_t>(i)].column == c; ++i) {
    const int off = std::abs(m_cells[static_cast<std::size_t>(i)].z - z);
    if (off < least) best = i, least = off;
  }
  return best;
}

}  // namespace semantic_planning
