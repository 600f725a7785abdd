#include "RelaxedField.h"

#include <algorithm>
#include <cstdlib>

#include "ground/GroundTiles.h"

namespace semantic_planning {

RelaxedField::RelaxedField(const Ground& ground) {
  for (const Column& place : ground.tiles()) {
    Tile& tile = m_tiles.at(place);
    tile.surfaces = ground.layers().surfaces().find(place);
    tile.place = place;
    tile.number = static_cast<std::int32_t>(m_numbered.size());
    m_numbered.push_back(&tile);
  }
}

const Surface* RelaxedField::near(Column c, int z, int tolerance) const {
  const Tile* const tile = m_tiles.find(tileOf(c));
  if (!tile) return nullptr;
  const Surface* best = nullptr;
  int least = tolerance + 1;
  for (const Surface& s : tile->surfaces->column(indexInTile(c))) {
    const int off = std::abs(s.z - z);
    if (s.drivable && off < least) best = &s, least = off;
  }
  return best;
}

RelaxedField::Place RelaxedField::placeNear(Column c, int z, int tolerance) const {
  const Surface* const surface = near(c, z, tolerance);
  if (!surface) return {};
  const Tile& tile = *m_tiles.find(tileOf(c));
  const auto index = surface - tile.surfaces->surfaces.data();
  return {c, surface, {tile.number, static_cast<std::uint16_t>(index)}};
}

RelaxedField::Place RelaxedField::placeOf(const Cell& cell) const {
  const Tile& tile = this->tile(cell);
  const auto& first = tile.surfaces->first;
  const auto after = std::upper_bound(first.begin(), first.end(), cell.index);
  const int index = static_cast<int>(after - first.begin()) - 1;
  const Column low = firstColumnOf(tile.place);
  return {{low.x + index % kTileEdge, low.y + index / kTileEdge},
          &tile.surfaces->surfaces[cell.index],
          cell};
}

RelaxedField::Label& RelaxedField::label(const Cell& cell) {
  Tile& tile = this->tile(cell);
  if (tile.labels.empty()) tile.labels.resize(tile.surfaces->surfaces.size());
  return tile.labels[cell.index];
}

}  // namespace semantic_planning
