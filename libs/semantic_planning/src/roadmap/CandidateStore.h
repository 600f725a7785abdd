#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_planning/roadmap/RoadmapOptions.h>

#include <vector>

#include "Candidates.h"
#include "ground/ColumnGrid.h"

namespace semantic_planning {

/** The candidate points of GraphKind::Compressed, Leaves and Full, which depend on the map and not
 * on start and goal: each tile's are looked for once and kept until the map changes there. Other
 * kinds have none. */
class CandidateStore {
 public:
  /** \param map, ground must outlive the store; with kinds of the tree (isOfTree) the map keeps
   * G-values.
   */
  CandidateStore(semantic_octree::SemanticOcTree& map, const Ground& ground,
                 const RoadmapOptions& options);

  const Ground& ground() const { return m_ground; }

  /** Least priority first. */
  const std::vector<CandidatePoint>& in(Column tile) { return made(tile).points; }

  void forget() { m_tiles = {}; }

  struct Change {
    std::vector<CandidatePoint> removed, added;
  };
  /** Brings the store up to date with map and ground. \param changedTiles of the ground
   * \return what changed in tiles that were asked for, or whose ground changed. */
  Change update(const semantic_octree::TileChange& touched,
                const std::vector<Column>& changedTiles);

 private:
  struct Tile {
    bool made = false;
    std::vector<CandidatePoint> points;
    int lowest = 0, highest = -1;  ///< keys of drivable surfaces
  };

  /** Whether the compressed tree's changes matter. */
  bool follows() const { return isOfTree(m_options.kind) && !m_map.isReadOnly(); }
  Tile& made(Column tile);
  Tile make(Column tile) const;
  /** Tiles whose points may depend on a leaf. */
  void addTilesOf(const semantic_octree::Cube& leaf, std::vector<Column>& tiles);
  std::vector<Column> outdated(const semantic_octree::TileChange& touched);

  semantic_octree::SemanticOcTree& m_map;
  semantic_octree::LeafFollower m_follower;  ///< of the compressed tree's leaves
  const Ground& m_ground;
  const RoadmapOptions m_options;
  ColumnGrid<Tile> m_tiles;
};

}  // namespace semantic_planning
