#include <synthetic_world/World.h>

#include <algorithm>
#include <cmath>

namespace synthetic_world {

SolidIndex::SolidIndex(const Terrain& terrain, const Solids& solids)
    : m_halfExtent(terrain.halfExtent()), m_width(terrain.cells()), m_highest(terrain.highest()) {
  m_cells.reserve(static_cast<std::size_t>(m_width) * m_width);
  for (int cy = 0; cy < m_width; ++cy)
    for (int cx = 0; cx < m_width; ++cx) m_cells.push_back({terrain.cellTop(cx, cy), {}});
  for (std::size_t i = 0; i < solids.size(); ++i) insert(solids[i], static_cast<std::uint32_t>(i));
}

int SolidIndex::cellOf(double coordinate) const {
  const double cell = std::floor((coordinate + m_halfExtent) / Terrain::kCell);
  return static_cast<int>(std::clamp(cell, 0.0, m_width - 1.0));
}

void SolidIndex::insert(const Solid& solid, std::uint32_t number) {
  const Section section = *solid.section(solid.low(), solid.high());
  const Eigen::Vector2d low = solid.center().array() - solid.radius();
  const Eigen::Vector2d high = solid.center().array() + solid.radius();
  for (int cy = cellOf(low.y()); cy <= cellOf(high.y()); ++cy)
    for (int cx = cellOf(low.x()); cx <= cellOf(high.x()); ++cx) {
      const Eigen::Vector2d middle(cx + 0.5 - m_halfExtent, cy + 0.5 - m_halfExtent);
      // A margin, so that rounding in the walk along a ray never steps around a solid.
      if (section.distanceTo(rectangle(middle, 0, 1.001, 1.001)) > 0) continue;
      Cell& cell = m_cells[cy * m_width + cx];
      cell.solids.push_back(number);
      cell.top = std::max(cell.top, solid.high());
    }
  m_highest = std::max(m_highest, solid.high());
}

}  // namespace synthetic_world
