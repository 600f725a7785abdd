#pragma once
#include <optional>
#include <vector>

#include "ColumnBox.h"
#include "Obstacles.h"

namespace semantic_planning {

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
  class Tile;

  /** A column to look at, seen from the surface's. */
  struct Place {
    int x, y;
    int clearance2;
    int tolerance;  ///< how far ground may have gone up or down on the way
  };

  int m_farthest;
  std::vector<Place> m_places;         ///< nearest first
  std::vector<std::size_t> m_firstAt;  ///< of m_places, by clearance2
};

}  // namespace semantic_planning
