#pragma once
#include <memory>

#include "Bridging.h"
#include "ColumnBox.h"
#include "GroundParts.h"
#include "GroundShape.h"
#include "Room.h"
#include "SurfaceTile.h"

namespace semantic_planning {

/** The stages from the map to the ground, each tile by tile; what a column becomes depends only on
 * the stage before within a fixed distance, and tiles are computed again only if that changed. */
class GroundTiles {
 public:
  GroundTiles(const semantic_octree::SemanticOcTree& map, const GroundShape& shape)
      : m_map(map), m_shape(shape), m_roomMeter(shape) {}

  /** \param tiles whose voxels may have changed \return tiles whose surfaces changed, sorted. */
  std::vector<Column> update(const std::vector<Column>& tiles);

  const GroundShape& shape() const { return m_shape; }
  const SurfaceGrid& surfaces() const { return m_surfaces; }
  const GroundParts& parts() const;

 private:
  /** Where surfaces are, and which of them are drivable. */
  std::vector<ColumnBox> updateSurfaces(const std::vector<Column>& tiles);
  /** How much room they have, and which are connected. */
  std::vector<ColumnBox> updateRoom(const std::vector<ColumnBox>& changed);

  /** Stages tell which columns of a tile changed.
   * \param refilled gets the tile if its surfaces changed */
  ColumnBox scan(Column tile, std::vector<Column>& refilled);
  /** \param refilled gets the tiles that bridges cross which came or went */
  void findBridges(Column tile, std::vector<Column>& refilled);
  ColumnBox fill(Column tile);
  ColumnBox markSlopes(Column tile);
  ColumnBox findObstacles(Column tile);
  ColumnBox measureRoom(Column tile);
  ColumnBox connect(Column tile);

  const semantic_octree::SemanticOcTree& m_map;
  const GroundShape m_shape;
  const RoomMeter m_roomMeter;
  ColumnGrid m_columns;
  SurfaceGrid m_measured;
  BridgeGrid m_bridges;
  SurfaceGrid m_surfaces;  ///< measured and bridging ones; the stages after that fill in the rest
  ObstacleGrid m_obstacles;
  mutable std::unique_ptr<GroundParts> m_parts;
};

}  // namespace semantic_planning
