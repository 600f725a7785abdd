#include "GroundComponents.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace semantic_planning {
namespace {

/** Half of a column's neighbors; the others look from their side. */
constexpr std::array<Column, 4> kForward = {{{1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

std::size_t rootOf(std::vector<std::size_t>& parent, std::size_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

void join(std::vector<std::size_t>& parent, std::size_t a, std::size_t b) {
  a = rootOf(parent, a);
  b = rootOf(parent, b);
  parent[std::max(a, b)] = std::min(a, b);
}

std::size_t numComponents(const SurfaceTile& tile) {
  std::size_t components = 0;
  for (const Surface& s : tile.surfaces)
    components = std::max<std::size_t>(components, s.component + 1);
  return components;
}

/** The drivable surface of a tile's column to which the wheels get from height z; or none. */
int climbableIndex(const SurfaceTile& tile, int column, int z, int step) {
  for (int i = tile.first[column]; i < tile.first[column + 1]; ++i)
    if (tile.surfaces[i].drivable && std::abs(int(tile.surfaces[i].z) - z) <= step) return i;
  return -1;
}

/** From 0 on, in the order of their first surfaces. \return the columns whose numbers changed. */
ColumnBox numberComponents(Column tile, std::vector<std::size_t>& parent, SurfaceTile& marked) {
  ColumnBox changed;
  std::uint16_t components = 0;
  std::vector<std::uint16_t> number(parent.size());
  forSurfacesOf(tile, marked, [&](Column c, std::size_t i) {
    const std::size_t root = rootOf(parent, i);
    number[i] = root == i ? components++ : number[root];
    if (marked.surfaces[i].component != number[i]) changed.add(c);
    marked.surfaces[i].component = number[i];
  });
  return changed;
}

}  // namespace

ColumnBox markComponents(Column tile, SurfaceTile& marked, const GroundShape& shape) {
  std::vector<std::size_t> parent(marked.surfaces.size());
  std::iota(parent.begin(), parent.end(), 0);
  forSurfacesOf(tile, marked, [&](Column c, std::size_t i) {
    if (!marked.surfaces[i].drivable) return;
    for (const Column& d : kForward) {
      const Column next{c.x + d.x, c.y + d.y};
      if (!(tileOf(next) == tile)) continue;
      const int j = climbableIndex(marked, indexInTile(next), marked.surfaces[i].z, shape.step);
      if (j >= 0) join(parent, i, j);
    }
  });
  return numberComponents(tile, parent, marked);
}

GroundComponents::GroundComponents(const SurfaceGrid& surfaces, const GroundShape& shape) {
  std::size_t components = 0;
  surfaces.forEach([&](Column tile, const SurfaceTile& t) {
    m_firstOfTile.at(tile) = components;
    components += numComponents(t);
  });
  m_parent.resize(components);
  std::iota(m_parent.begin(), m_parent.end(), 0);
  surfaces.forEach([&](Column tile, const SurfaceTile& t) {
    if (!t.surfaces.empty()) joinAcrossBorders(surfaces, tile, shape);
  });
  for (std::size_t i = 0; i < m_parent.size(); ++i) m_parent[i] = rootOf(m_parent, i);
}

void GroundComponents::joinAcrossBorders(const SurfaceGrid& surfaces, Column tile,
                                         const GroundShape& shape) {
  forColumnsOf(tile, [&](Column c) {
    const Column inTile{c.x & 15, c.y & 15};
    if (inTile.x > 0 && inTile.x < kTileEdge - 1 && inTile.y < kTileEdge - 1) return;
    for (const Surface& s : surfacesAt(surfaces, c))
      for (const Column& d : kForward) {
        const Column next{c.x + d.x, c.y + d.y};
        const Surface* other = s.drivable ? surfaceNear(surfaces, next, s.z, shape.step) : nullptr;
        if (other && other->drivable)
          join(m_parent, *m_firstOfTile.find(tile) + s.component,
               *m_firstOfTile.find(tileOf(next)) + other->component);
      }
  });
}

std::size_t GroundComponents::componentOf(Column c, const Surface& s) const {
  return m_parent[*m_firstOfTile.find(tileOf(c)) + s.component];
}

}  // namespace semantic_planning
