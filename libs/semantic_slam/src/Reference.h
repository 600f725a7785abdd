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
  /** The map is not needed afterwards. \param cellSizes edges of cubes, meters
   * \param useClasses false: all points are of one class */
  Reference(const semantic_octree::SemanticOcTree& map, std::vector<double> cellSizes,
            bool useClasses);

  bool exists() const { return m_voxelSize > 0; }
  /** Standard deviation of the middle of a voxel as a surface's place, m: more points do not make
   * it less. */
  double deviation() const;

  /** What a scan in space is compared with. */
  const std::vector<Submap>& inSpace();
  /** What a scan of horizontal beams is compared with, in x and y alone: its layers of voxels, at
   * least two, for it may lie between. */
  const std::vector<Submap>& sliceAt(const LabeledCloud& scan, const Eigen::Isometry3d& T_map_scan);

 private:
  /** Where the lowest begins and the highest ends, in voxels. */
  using Layers = std::pair<double, double>;
  Layers layersOf(const LabeledCloud& scan, const Eigen::Isometry3d& T_map_scan) const;

  double m_voxelSize = 0;  // m
  std::vector<double> m_cellSizes;
  bool m_useClasses = true;
  LabeledCloud m_voxels;
  std::vector<Submap> m_submaps;  ///< that were asked for last
  bool m_isSlice = false;         ///< of these layers
  Layers m_layers;
};

}  // namespace semantic_slam
