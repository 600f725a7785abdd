#pragma once
#include <labeled_cloud/ScanConverter.h>
#include <semantic_octree/SemanticOcTree.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace rawlog2semantic_map {

/** Tells by scans and their map whether a sensor is mounted, or scaled, otherwise than its
 * observations say. */
class Doubts {
 public:
  void add(const labeled_cloud::LabeledScan& scan, const Eigen::Isometry3d& T_map_sensor);

  /** What is wrong, in words. \param maxRange of the insertion, m; 0: none */
  std::vector<std::string> warnings(const semantic_octree::SemanticOcTree& map,
                                    double maxRange) const;

 private:
  /** Whether the ground around the robot is above its sensor: more columns of the map have
   * something only above the sensor than only below. Below a low ceiling they may have so, too, but
   * then as many points are below the sensor. */
  bool isUpsideDown(const semantic_octree::SemanticOcTree& map) const;

  std::vector<Eigen::Vector3d> m_places;  ///< of sensors, m, map frame
  std::vector<double> m_ranges;           ///< medians of scans, m
  std::size_t m_above = 0, m_below = 0;   ///< points that are steeply so
};

}  // namespace rawlog2semantic_map
