#pragma once
#include <semantic_planning/ground/Ground.h>

#include <array>
#include <cstdint>
#include <vector>

#include "ground/ColumnGrid.h"
#include "roadmap/PlanningRegion.h"

namespace semantic_planning {

/** The drivable surfaces of a region's columns side by side, to be looked up often. */
class GuideRaster {
 public:
  static constexpr int kNone = -1;

  struct Cell {
    Column column;
    std::uint16_t z;
    ClassId classId;
    std::uint16_t clearance2;
  };

  GuideRaster(const Ground& ground, const PlanningRegion& region);

  int size() const { return static_cast<int>(m_cells.size()); }
  const Cell& operator[](int cell) const { return m_cells[static_cast<std::size_t>(cell)]; }
  /** The column's cell nearest to a height, at most `tolerance` voxels off; or kNone. */
  int near(Column c, int z, int tolerance) const;

 private:
  void add(Column tile, const Ground& ground);

  /** By column; its cells follow each other. */
  ColumnGrid<std::array<std::int32_t, kTileColumns>> m_first;
  std::vector<Cell> m_cells;
};

}  // namespace semantic_planning
