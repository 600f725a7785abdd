#pragma once
#include <synthetic_world/GroundCover.h>
#include <synthetic_world/SolidIndex.h>
#include <Eigen/Geometry>

namespace synthetic_world {

/** What a ray meets first. */
struct Hit {
  double range = 0;  // meters
  Eigen::Vector3d point, normal;
  Material material;
  bool onGround = false;
};

/** The truth about a point. */
struct PointTruth {
  enum class State { Free, Surface, Inside, Underground };
  State state = State::Free;
  ClassId id = kNoClass;  // of the nearest surface; kNoClass where free

  bool operator==(const PointTruth& o) const { return state == o.state && id == o.id; }
};

/** Outline and heights of a robot. */
struct Footprint {
  Polygon outline = rectangle({0, 0}, 0, 0.9, 0.6);  // robot frame, meters
  double clearance = 0.1;                            // m; lower things are driven over
  double height = 1.2;                               // m

  /** \throw std::invalid_argument naming the field. */
  void validate() const;
};

/** A place: ground with classes, and solids that stand on it. Frame: x, y, z up, meters.
 *
 * Queries do not change the world and may run in parallel. */
class World {
 public:
  World(Terrain terrain, GroundCover cover, Solids solids);

  const Terrain& terrain() const { return m_terrain; }
  const Solids& solids() const { return m_solids; }
  double halfExtent() const { return m_terrain.halfExtent(); }

  double groundHeight(double x, double y) const { return m_terrain.height(x, y); }
  ClassId groundClass(double x, double y) const { return m_cover.at(x, y); }
  /** Pose of a robot that stands on the ground: its x axis ahead, its z axis along the normal. */
  Eigen::Isometry3d poseOnGround(double x, double y, double yaw) const;

  /** Things that come, go and move, in addition to those of the scene (a person, a roadblock).
   * Replaces those set before. */
  void setMovables(Solids movables) { m_movables = std::move(movables); }
  const Solids& movables() const { return m_movables; }

  /** What is at a point.
   *
   * Surface: within `tolerance` meters of the ground or of a solid's surface. Inside: deeper in a
   * solid; Underground: deeper in the ground. The class is that of the nearest surface. Near the
   * edges of a solid the tolerance reaches a little further, to the corner of its offset faces. */
  PointTruth at(const Eigen::Vector3d& p, double tolerance = 0.01) const;

  /** The nearest surface along a ray.
   * \param direction Unit length.
   * \param maxRange Meters.
   * A ray that starts in a solid or below the ground hits at range 0. */
  std::optional<Hit> castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double maxRange) const;

  /** Distance in meters, measured in the plane, from a robot at (x, y, yaw) to the nearest solid in
   * its heights; 0 is a collision. Not more than `limit`. */
  double clearance(const Footprint& footprint, double x, double y, double yaw,
                   double limit = 5.0) const;
  bool isFree(const Footprint& footprint, double x, double y, double yaw) const {
    return clearance(footprint, x, y, yaw, 0.01) > 0;
  }

 private:
  Terrain m_terrain;
  GroundCover m_cover;
  Solids m_solids, m_movables;
  SolidIndex m_index;
};

}  // namespace synthetic_world
