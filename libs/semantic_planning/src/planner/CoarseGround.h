#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "ground/SurfaceTile.h"

namespace semantic_planning {

/** The ground in parts of tiles: where the middle of a vehicle gets without leaving the tile, which
 * keeps the clearance that the smallest disc of its footprint needs. Parts are found square by
 * square when they are asked for, and kept; the ground is not. */
class CoarseGround {
 public:
  /** Which of a tile's parts. */
  struct Id {
    Column tile;
    std::uint16_t number = 0;
    bool operator==(const Id& o) const { return tile == o.tile && number == o.number; }
    bool operator<(const Id& o) const { return tile == o.tile ? number < o.number : tile < o.tile; }
  };
  struct Part {
    std::uint16_t number;
    /** The best for which, together with better ones, there are as many columns as from one side
     * of the tile to the other. */
    colored_graph::Rank rank = 0;
    std::vector<Id> next;  ///< in other tiles, one step of the wheels away
  };

  /** All must outlive this. */
  CoarseGround(const semantic_octree::SemanticOcTree& map, const colored_graph::ClassOrder& order,
               const PlannerOptions& options);

  const Part& at(const Id& id);
  /** The nearest part to where the ground is, at most about a tile off. */
  std::optional<Id> near(const mrpt::math::TPose2D& pose, std::optional<double> z);

 private:
  Ground groundIn(const std::vector<Column>& tiles) const;
  SurfaceGrid partsOf(const Ground& ground, const std::vector<Column>& tiles) const;
  void makeSquare(Column square);
  void addParts(Column tile, const SurfaceGrid& parts, int step);
  colored_graph::Rank rankOf(const std::vector<int>& columnsOfRank) const;

  const semantic_octree::SemanticOcTree& m_map;
  const colored_graph::ClassOrder& m_order;
  const PlannerOptions& m_options;
  double m_radius;  ///< of the smallest disc, meters
  ColumnGrid<std::vector<Part>> m_parts;
  ColumnGrid<char> m_madeSquares;
};

}  // namespace semantic_planning
