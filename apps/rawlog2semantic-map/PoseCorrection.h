#pragma once
#include <labeled_cloud/LabeledScan.h>
#include <map_correction/KeyframeMap.h>
#include <semantic_slam/Slam.h>

#include <filesystem>

#include "Summary.h"

namespace rawlog2semantic_map {

/** Inserts scans where SLAM finds them, and moves them when it changes its mind. */
class PoseCorrection {
 public:
  /** \param map empty; must outlive this \param folder where scans are kept meanwhile */
  PoseCorrection(semantic_octree::SemanticOcTree& map, const semantic_slam::SlamOptions& options,
                 const std::filesystem::path& folder);
  /** Before the first scan, see semantic_slam::Slam. */
  void setReference(const semantic_octree::SemanticOcTree& map) { m_slam.setReference(map); }

  /** \param T_map_robot as odometry has it \param secondsSince by which the map ages first */
  semantic_octree::InsertionReport insert(const labeled_cloud::LabeledScan& scan,
                                          const mrpt::poses::CPose3D& T_map_robot,
                                          const semantic_octree::InsertionOptions& options,
                                          double secondsSince);

  /** The map is then that of the poses of trajectory(), exactly. */
  void finish() { m_keyframes.move(posesOf(m_slam)); }

  SlamSummary summary() const;
  /** Of all keyframes, in the format of the TUM data sets. */
  std::string trajectory() const;

 private:
  semantic_slam::Slam m_slam;
  semantic_octree::KeyframeMap m_keyframes;
  std::vector<double> m_times;  ///< of keyframes, seconds
};

}  // namespace rawlog2semantic_map
