#pragma once
#include "ColumnGrid.h"
#include "GroundShape.h"
#include "SurfaceTile.h"

#include <vector>

namespace semantic_planning {

/** Sets Surface::component: which drivable surfaces the wheels connect within the tile.
 * \return the columns where it changed. */
ColumnBox markComponents(Column tile, SurfaceTile& marked, const GroundShape& shape);

/** Which components of tiles belong together. */
class GroundComponents {
 public:
  /** \param surfaces with `component` set. */
  GroundComponents(const SurfaceGrid& surfaces, const GroundShape& shape);

  /** One number for all surfaces that drivable ground connects. */
  std::size_t componentOf(Column c, const Surface& s) const;

 private:
  void joinAcrossBorders(const SurfaceGrid& surfaces, Column tile, const GroundShape& shape);

  ColumnGrid<std::size_t> m_firstOfTile;
  std::vector<std::size_t> m_parent;  ///< the root of each component
};

}  // namespace semantic_planning
