#include "GroundTiles.h"

#include <algorithm>

#include "Room.h"
#include "Slope.h"

namespace semantic_planning {
namespace {

/** The tiles that hold columns within `reach` of one of these tiles, sorted. */
std::vector<Column> tilesAround(const std::vector<Column>& tiles, int reach) {
  const int ring = (reach + kTileEdge - 1) / kTileEdge;
  std::vector<Column> around;
  for (const Column& t : tiles)
    for (int y = -ring; y <= ring; ++y)
      for (int x = -ring; x <= ring; ++x) around.push_back({t.x + x, t.y + y});
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  return around;
}

/** Those for which the stage answers that it made something else than before. */
template <class Stage>
std::vector<Column> changedBy(const std::vector<Column>& tiles, Stage stage) {
  std::vector<Column> changed;
  for (const Column& tile : tiles)
    if (stage(tile)) changed.push_back(tile);
  return changed;
}

template <class Grid, class Tile>
bool replace(Grid& grid, Column tile, Tile value) {
  const Tile* before = grid.find(tile);
  if (before ? *before == value : value == Tile()) return false;
  grid.at(tile) = std::move(value);
  return true;
}

}  // namespace

std::vector<Column> GroundTiles::update(const std::vector<Column>& tiles) {
  const auto scanned = changedBy(tiles, [this](Column t) { return scan(t); });
  const auto bridged = changedBy(tilesAround(scanned, static_cast<int>(m_shape.widestGap) + 1),
                                 [this](Column t) { return bridge(t); });
  auto sloped =
      changedBy(tilesAround(bridged, m_shape.baseline), [this](Column t) { return markSlopes(t); });
  auto changed = changedBy(tilesAround(sloped, m_shape.farthestRoom + 1),
                           [this](Column t) { return finish(t); });
  if (!changed.empty()) m_parts.reset();
  return changed;
}

bool GroundTiles::scan(Column tile) {
  ColumnTile columns = scanColumns(m_map, tile);
  SurfaceTile measured = measuredSurfaces(columns, m_shape);
  const bool otherColumns = replace(m_columns, tile, std::move(columns));
  const bool otherSurfaces = replace(m_measured, tile, std::move(measured));
  return otherColumns || otherSurfaces;
}

bool GroundTiles::bridge(Column tile) {
  return replace(m_bridged, tile, bridgedSurfaces(m_columns, m_measured, tile, m_shape));
}

bool GroundTiles::markSlopes(Column tile) {
  const SurfaceTile* bridged = m_bridged.find(tile);
  if (!bridged) return false;
  SurfaceTile marked = *bridged;
  markDrivable(m_bridged, tile, marked, m_shape);
  return replace(m_sloped, tile, std::move(marked));
}

bool GroundTiles::finish(Column tile) {
  const SurfaceTile* sloped = m_sloped.find(tile);
  if (!sloped) return false;
  SurfaceTile finished = *sloped;
  measureRoom(m_sloped, tile, finished, m_shape);
  markParts(tile, finished, m_shape);
  return replace(m_surfaces, tile, std::move(finished));
}

const GroundParts& GroundTiles::parts() const {
  if (!m_parts) m_parts = std::make_unique<GroundParts>(m_surfaces, m_shape);
  return *m_parts;
}

}  // namespace semantic_planning
