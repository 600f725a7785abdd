#pragma once
#include <octomap/OcTreeKey.h>
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>
#include <unordered_map>
#include <utility>
#include <vector>

#include "Evaluation.h"

namespace semantic_map_evaluate {

/** What maps are held against: the labels in each voxel, counted. With n_k of class k of n, and K
 * classes, p(class k) = (n_k + a/K) / (n + a): the mean of a Dirichlet distribution whose prior
 * counts like a = 0.1 labels. */
class LabelCounts {
 public:
  enum class Counted {
    Labels,  ///< each counts as one
    Scans    ///< each counts as one in a voxel, shared by its labels there
  };
  /** \param map whose voxels and classes are used; must outlive the counts */
  LabelCounts(const semantic_octree::SemanticOcTree& map, Counted counted)
      : m_map(map), m_counted(counted) {}

  void add(const semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor);
  /** A voxel is occupied if it has a label; the lowest id is likeliest on a tie.
   * \param point meters, map frame */
  Evaluation::Answer answer(const Eigen::Vector3d& point, semantic_octree::ClassId truth) const;

 private:
  /** By class. */
  using Counts = std::vector<std::pair<semantic_octree::ClassId, double>>;
  using Voxels = std::unordered_map<octomap::OcTreeKey, Counts, octomap::OcTreeKey::KeyHash>;
  static double& countOf(Counts& counts, semantic_octree::ClassId id);

  const semantic_octree::SemanticOcTree& m_map;
  Counted m_counted;
  Voxels m_voxels;
};

}  // namespace semantic_map_evaluate
