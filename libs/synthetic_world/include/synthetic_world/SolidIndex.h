#pragma once
#include <synthetic_world/Solid.h>
#include <synthetic_world/Terrain.h>
#include <cstdint>

namespace synthetic_world {

/** Which solids stand in which cell of the terrain. */
class SolidIndex {
 public:
  SolidIndex(const Terrain& terrain, const Solids& solids);

  /** Numbers of the solids that reach into a cell. */
  const std::vector<std::uint32_t>& solids(int cx, int cy) const { return at(cx, cy).solids; }
  /** Nothing in the cell, ground included, is higher than this. */
  double top(int cx, int cy) const { return at(cx, cy).top; }
  /** Nothing in the world is higher than this. */
  double highest() const { return m_highest; }
  /** Cell of a coordinate, the nearest one for a coordinate beyond the edge. */
  int cellOf(double coordinate) const;

 private:
  struct Cell {
    double top;
    std::vector<std::uint32_t> solids;
  };
  const Cell& at(int cx, int cy) const { return m_cells[cy * m_width + cx]; }
  void insert(const Solid& solid, std::uint32_t number);

  double m_halfExtent;
  int m_width;
  double m_highest;
  std::vector<Cell> m_cells;
};

}  // namespace synthetic_world
