#pragma once
#include <colored_graph/ClassOrder.h>
#include <semantic_octree/Keys.h>
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_planning/ground/GroundOptions.h>
#include <semantic_planning/ground/Surface.h>
#include <semantic_planning/vehicle/VehicleOptions.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

namespace semantic_planning {

class GroundTiles;

/** A surface and the column that it is in. */
struct GroundPoint {
  Column column;
  Surface surface;
};

/** The drivable ground of a map, column by column.
 *
 * A surface is an occupied voxel with the vehicle's height free of occupied voxels above it; holes
 * between surfaces are filled (GroundOptions). Neighboring surfaces are connected if they differ
 * by at most the step height. Everything is a function of the map alone: after update() ground,
 * classes and distances are as if read anew. Only what somebody knows better (assume()) comes on
 * top. */
class Ground {
 public:
  /** \param map must outlive the ground.
   * \param order its classes are the map's ids, with semantic_types::kNoClass for unknown ground.
   * \throw std::invalid_argument bad options, or an order of other classes. */
  Ground(const semantic_octree::SemanticOcTree& map, const VehicleOptions& vehicle,
         const GroundOptions& options, const colored_graph::ClassOrder& order);
  ~Ground();
  Ground(Ground&&) noexcept;

  /** Reads again what changed. \return the tiles (of kTileEdge x kTileEdge columns) whose surfaces
   * changed in anything. */
  std::vector<Column> update(const semantic_octree::TileChange& change);
  /** Takes it that there is ground in these columns where the map knows none and saw no drop, in
   * place of what was assumed before. Not in the ground of a map that is read only.
   * \return as update() */
  std::vector<Column> assume(const std::vector<GroundPoint>& points);

  const semantic_octree::SemanticOcTree& map() const { return m_map; }
  double voxelSize() const { return m_voxelSize; }

  /** Key of the voxel that holds a coordinate, and the center of one: map frame, meters. */
  int keyOf(double meters) const {
    return semantic_octree::floorOf(meters * m_perMeter) + semantic_octree::kKeyOfOrigin;
  }
  double centerOf(int key) const { return semantic_octree::centerOf(key, m_voxelSize); }

  /** The column that holds a point, map frame, meters. */
  Column columnAt(double x, double y) const { return {keyOf(x), keyOf(y)}; }

  SurfaceRange surfaces(Column c) const;
  /** The column's surface nearest in height to key z, at most `tolerance` voxels off; or null.
   * Valid until update(). */
  const Surface* near(Column c, int z, int tolerance) const;
  /** Whether the map held something occupied in a column between two heights (keys, these
   * included), at the last update. */
  bool isOccupied(Column c, int low, int high) const;
  /** The surface nearest to a height (meters), without one the lowest drivable one. */
  std::optional<GroundPoint> find(double x, double y, std::optional<double> nearZ = {}) const;

  /** Voxels that the wheels can climb from one column to the next. */
  int step() const { return m_step; }
  /** Largest distance in voxels that surfaces know (Surface::clearance2). */
  int largestClearance() const { return m_largestClearance; }
  /** Whether a disc of this radius (m) has the vehicle's clearance, wherever in the surface's
   * column its center is. It counts from walls, steps, steep and perhaps forbidden ground, and the
   * unknown. */
  bool hasClearance(const Surface& surface, double radius) const {
    const double needed = (radius + m_clearance) / m_voxelSize;
    return surface.drivable && surface.clearance2 >= needed * needed;
  }
  /** Whether the wheels can get from one place to the other, step by step. The first call after
   * an update finds out for the whole ground: not for several threads at once. */
  bool connected(const GroundPoint& a, const GroundPoint& b) const;

  /** A copy that stays as it is, of surfaces alone; it shares memory with this until this changes.
   */
  Ground frozen() const;

  /** The tiles that there are. */
  std::vector<Column> tiles() const;

  /** For use within the library only. */
  const GroundTiles& layers() const { return *m_tiles; }

 private:
  Ground(const Ground& of, std::unique_ptr<GroundTiles> tiles);

  std::unique_ptr<GroundTiles> m_tiles;
  const semantic_octree::SemanticOcTree& m_map;
  double m_voxelSize, m_clearance;
  double m_perMeter;  ///< voxels, as keyOf() of semantic_octree has them: it divides each time
  int m_step, m_largestClearance;
};

/** How high the origin of a robot's frame is above the ground. REP 105 lets base_link be anywhere
 * on a robot: at its wheels, in its middle, at its LiDAR. So the map is asked: the ground is what
 * was seen around the robot, not above the origin, connected, and may be driven upon. Looks from
 * different places make it sure; then it stays. */
class FrameHeight {
 public:
  /** The robot is there, and the ground is that of all scans until now. */
  void look(const Ground& ground, const VehicleOptions& vehicle,
            const Eigen::Isometry3d& T_map_robot);
  /** Meters; 0 for less than the map can tell. None: no ground was seen yet. */
  std::optional<double> meters() const;
  /** A pose with the height of the ground below, as far as that is known. */
  Eigen::Isometry3d onGround(const Eigen::Isometry3d& T_map_robot) const {
    return T_map_robot * Eigen::Translation3d(0, 0, -meters().value_or(0));
  }

 private:
  std::vector<double> m_heights;  ///< by looks from different places
  Eigen::Vector3d m_lookedAt;     ///< the last time, map frame
};

}  // namespace semantic_planning
