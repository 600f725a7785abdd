#pragma once
#include <memory>

#include "Bridging.h"
#include "GroundParts.h"
#include "GroundShape.h"
#include "SurfaceTile.h"

namespace semantic_planning {

/** The stages from the map to the ground, each tile by tile; what a tile becomes depends only on
 * the stage before within a fixed distance, and tiles are computed again only if that changed. */
class GroundTiles {
 public:
  GroundTiles(const semantic_octree::SemanticOcTree& map, const GroundShape& shape)
      : m_map(map), m_shape(shape) {}

  /** \param tiles whose voxels may have changed \return tiles whose surfaces changed. */
  std::vector<Column> update(const std::vector<Column>& tiles);

  const GroundShape& shape() const { return m_shape; }
  const SurfaceGrid& surfaces() const { return m_surfaces; }
  const GroundParts& parts() const;

 private:
  bool scan(Column tile);
  bool bridge(Column tile);
  bool markSlopes(Column tile);
  bool finish(Column tile);

  const semantic_octree::SemanticOcTree& m_map;
  const GroundShape m_shape;
  ColumnGrid m_columns;
  SurfaceGrid m_measured, m_bridged, m_sloped, m_surfaces;
  mutable std::unique_ptr<GroundParts> m_parts;
};

}  // namespace semantic_planning
