#pragma once
#include <memory>
#include <optional>

#include "ColumnGrid.h"
#include "GapFills.h"
#include "SurfaceMarks.h"
#include "SurfaceTile.h"

namespace semantic_planning {

/** Ground of a map that is too large as a whole is made in squares of so many tiles a side. */
constexpr int kSquareEdge = 32;
inline Column squareOf(Column tile) { return {tile.x >> 5, tile.y >> 5}; }

/** Columns within which what the map holds may matter to a column's surfaces. */
inline int reachOfGround(const GroundShape& shape) {
  return kReachOfClasses + reachOfGapFills(shape) + shape.baseline + 1 + shape.largestClearance;
}

/** The stages from the map to the ground, each tile by tile. A column follows from the stage before
 * within a fixed distance; tiles are computed again only if that changed.
 *
 * The stages before the surfaces take more memory than these. They are kept around what changed of
 * late, and made again elsewhere when something changes there. */
class GroundTiles {
 public:
  GroundTiles(const semantic_octree::SemanticOcTree& map, const GroundShape& shape)
      : m_map(map), m_shape(shape), m_clearanceMeter(shape), m_scanner(map) {}

  /** In the beginning. \param tiles all in which there may be ground */
  void read(const std::vector<Column>& tiles);
  /** In these tiles, those of the whole map. The stages before are made square by square and
   * forgotten. */
  void readSquares(const std::vector<Column>& tiles);
  /** \param tiles whose voxels may have changed \return tiles whose surfaces changed, sorted. */
  std::vector<Column> update(const std::vector<Column>& tiles);

  /** Somebody knows ground that the map does not: it counts in columns without a surface, where the
   * map saw no drop. What was assumed before is forgotten.
   * \return tiles whose surfaces changed, sorted. */
  std::vector<Column> assume(SurfaceGrid ground);

  /** The surfaces as they are now, without the stages before. */
  std::unique_ptr<GroundTiles> frozen() const;

  /** Tiles that may have surfaces, or stages before. */
  std::vector<Column> known() const;

  const GroundShape& shape() const { return m_shape; }
  const SurfaceGrid& surfaces() const { return m_surfaces; }
  /** Whether something is occupied between two heights, these included. */
  bool isOccupied(Column c, int low, int high) const;
  /** What surfaces near a column at height z keep their clearance from; none within the largest. */
  std::optional<ClearanceMeter::Obstacle> obstacleNear(Column c, int z) const;
  const GroundComponents& components() const;

 private:
  /** The stages before the surfaces. */
  void forgetStages();
  /** Makes them again, before an update, where it needs them. */
  void recallStages(const std::vector<Column>& tiles);
  /** Where surfaces are, and which of them are drivable. \param refilled tiles that are filled
   * again in any case */
  std::vector<ColumnBox> updateSurfaces(const std::vector<Column>& tiles,
                                        std::vector<Column> refilled = {});
  /** \param changed columns, in the stages up to measure() \param refilled their tiles */
  std::vector<ColumnBox> updateSurfaces(std::vector<ColumnBox> changed,
                                        std::vector<Column> refilled);
  std::vector<Column> finished(std::vector<ColumnBox> changed);
  /** How much clearance they have, and which are connected. */
  std::vector<ColumnBox> updateClearance(const std::vector<ColumnBox>& changed);

  SurfaceTile measured(Column tile) const;
  void findFills(Column tile);
  /** Stages tell which columns of a tile changed. */
  ColumnBox fill(Column tile);
  ColumnBox findObstacles(Column tile);

  const semantic_octree::SemanticOcTree& m_map;
  const GroundShape m_shape;
  const ClearanceMeter m_clearanceMeter;
  const semantic_octree::ColumnScanner m_scanner;
  ScanGrid m_columns;
  SurfaceGrid m_measured, m_assumed;
  GapFillGrid m_fills;
  SurfaceGrid m_surfaces;  ///< measured ones and gap fills; the stages after that fill in the rest
  ObstacleGrid m_obstacles;
  /** Tiles that were read since the stages were forgotten; the most that an update needed. */
  std::size_t m_numRead = 0, m_mostNeeded = 0;
  mutable std::unique_ptr<GroundComponents> m_components;
};

}  // namespace semantic_planning
