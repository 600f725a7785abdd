#pragma once
#include <semantic_octree/InsertionOptions.h>
#include <semantic_octree/store/Cell.h>
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

namespace semantic_octree {

/** What becomes of a point: where its beam ends, in voxel units of the map (coordinate /
 * resolution). */
struct Beam {
  enum class Kind : std::uint8_t {
    NotFinite,  ///< not used, nor are the next two
    Near,
    Outside,
    Return,
    Clipped  ///< the return lies beyond the maximum range, where this end is
  };
  Kind kind;
  Eigen::Array3d end;  ///< the sensor, if NotFinite or Near

  bool isUsed() const { return kind >= Kind::Return; }
  bool isReturn() const { return kind == Kind::Return; }
};

/** A scan's beams in the map's frame. They are computed when asked for, always the same: to keep
 * them would take more memory than all else that is known of a scan. */
class ScanBeams {
 public:
  /** \param cloud must outlive this
   * \throw std::out_of_range the sensor lies outside the map. */
  ScanBeams(const semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
            double resolution, const InsertionOptions& options);

  std::size_t size() const { return m_cloud.size(); }
  /** The sensor, voxel units. */
  const Eigen::Array3d& origin() const { return m_origin; }
  Beam beam(std::size_t point) const;

  /** Box of voxels that the beams cross, inclusive. */
  const VoxelIndex& lowest() const { return m_lowest; }
  const VoxelIndex& highest() const { return m_highest; }
  /** How many points became what. */
  const InsertionReport& report() const { return m_report; }

  static VoxelIndex voxelOf(const Eigen::Array3d& u) {
    return {floorOf(u.x()), floorOf(u.y()), floorOf(u.z())};
  }
  static bool insideMap(const Eigen::Array3d& u) {
    return (u >= -kKeyOfOrigin).all() && (u < kKeyOfOrigin).all();
  }

 private:
  Eigen::Array3d endOf(const Eigen::Vector3d& p, double scale) const;
  static Beam beamTo(const Eigen::Array3d& end, Beam::Kind kind);

  const semantic_types::LabeledCloud& m_cloud;
  Eigen::Array3d m_origin;
  Eigen::Matrix3d m_rotation;                   ///< meters to voxels, too
  double m_maxRange, m_minRange2, m_maxRange2;  ///< meters; squared
  VoxelIndex m_lowest, m_highest;
  InsertionReport m_report;
};

inline Beam ScanBeams::beam(std::size_t point) const {
  const Eigen::Vector3d p = m_cloud.points[point].cast<double>();
  const double range2 = p.x() * p.x() + (p.y() * p.y() + p.z() * p.z());
  if (range2 >= m_minRange2 && range2 <= m_maxRange2)
    return beamTo(endOf(p, 1), Beam::Kind::Return);
  if (!std::isfinite(range2)) return {Beam::Kind::NotFinite, m_origin};
  if (range2 < m_minRange2) return {Beam::Kind::Near, m_origin};
  return beamTo(endOf(p, m_maxRange / std::sqrt(range2)), Beam::Kind::Clipped);
}

inline Eigen::Array3d ScanBeams::endOf(const Eigen::Vector3d& p, double scale) const {
  Eigen::Array3d end;
  for (int i = 0; i < 3; ++i)
    end[i] =
        m_origin[i] +
        (m_rotation(i, 0) * p.x() + (m_rotation(i, 1) * p.y() + m_rotation(i, 2) * p.z())) * scale;
  return end;
}

inline Beam ScanBeams::beamTo(const Eigen::Array3d& end, Beam::Kind kind) {
  return {insideMap(end) ? kind : Beam::Kind::Outside, end};
}

}  // namespace semantic_octree
