#pragma once
#include <semantic_octree/ColumnScan.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "ColumnGrid.h"
#include "SurfaceTile.h"

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

/** Where the vehicle must not be: for each column of a tile the heights (keys) about which it is an
 * obstacle. */
using ObstacleTile = semantic_octree::ByColumn<std::uint16_t>;
using ObstacleGrid = ColumnGrid<ObstacleTile>;

/** A surface that is not free (not drivable, or to be kept off) is an obstacle. So is a column
 * beside free ground that has no surface within a step of its height.
 * \param surfaces with `drivable` set. */
ObstacleTile obstaclesIn(const SurfaceGrid& surfaces, Column tile, const GroundShape& shape);

/** Measures Surface::clearance2: from obstacles at about a surface's height, not farther than the
 * largest clearance. Exact. */
class ClearanceMeter {
 public:
  explicit ClearanceMeter(const GroundShape& shape);

  /** Where the vehicle must not be, and about which height. */
  struct Obstacle {
    Column column;
    int z;
    int clearance2;  ///< of the surface that asks
  };
  /** The nearest one to a column at height z. */
  std::optional<Obstacle> nearest(const ObstacleGrid& obstacles, Column c, int z) const;

  /** Sets the clearance of a tile's surfaces. \return the columns where it changed. */
  ColumnBox measure(const ObstacleGrid& obstacles, Column tile, SurfaceTile& measured) const;

 private:
  /** A column to look at, seen from the surface's. */
  struct Place {
    int x, y;
    int clearance2;
    int tolerance;  ///< how far ground may have gone up or down on the way
    int offset;     ///< in Around
  };

  class Around;
  std::optional<Obstacle> nearest(const Around& around, Column c, int z) const;

  int m_farthest;
  std::vector<Place> m_places;  ///< nearest first
};

}  // namespace semantic_planning
