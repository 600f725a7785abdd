#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_slam/Registration.h>

#include <utility>
#include <vector>

namespace semantic_slam {

/** A map that is there already, for scans to be registered to: the middles of its occupied voxels,
 * map frame. Leaves larger than the smallest cube say nothing of surfaces and are left out. */
class Reference {
 public:
  /** None. */
  Reference() = default;
  /** The map is not needed afterwards. \param useClasses false: all points are of one class */
  Reference(const semantic_octree::SemanticOcTree& map, bool useClasses);

  bool exists() const { return m_voxelSize > 0; }
  /** Standard deviation of the middle of a voxel as a surface's place, m: more points do not make
   * it less. */
  double deviation() const;

  /** What a scan is compared with. If its beams are horizontal, that are its layers of voxels, at
   * least two, for it may lie between; x and y alone count then. */
  const std::vector<Submap>& submapsFor(const LabeledCloud& scan,
                                        const Eigen::Isometry3d& T_map_scan, bool isPlanar);

 private:
  /** Where the lowest begins and the highest ends, in voxels. */
  using Layers = std::pair<double, double>;
  Layers layersOf(const LabeledCloud& scan, const Eigen::Isometry3d& T_map_scan) const;

  double m_voxelSize = 0;  // m
  bool m_useClasses = true;
  LabeledCloud m_voxels;
  std::vector<Submap> m_submaps;  ///< that were asked for last
  Layers m_layers = {0, 0};       ///< of these; in space: all
};

}  // namespace semantic_slam
