#pragma once
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>
#include <string>
#include <unordered_map>
#include <vector>

namespace labeled_cloud {

/** How often hard labels name which class where another one is true, from labels alone: voxels that
 * several scans saw have one class, which is not known, and a label from each (Dawid and Skene,
 * "Maximum Likelihood Estimation of Observer Error-Rates Using the EM Algorithm", 1979).
 *
 * What all scans repeat cannot be seen this way. */
class ConfusionEstimate {
 public:
  /** \param voxelSize meters \param numClasses K > 1 */
  ConfusionEstimate(double voxelSize, int numClasses)
      : m_voxelSize(voxelSize), m_numClasses(numClasses) {}

  /** The labels of one scan: each voxel has that of most of its points, the lowest id on a tie.
   * \param least, most meters from the sensor; what is nearer or farther does not count */
  void add(const semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
           double least, double most);

  /** K x K expected counts for ConfusionMatrix: row is the true class, column the label. Beside
   * what was seen, 1000 labels of each class are right with probability `accuracy`, (1/K, 1). */
  std::vector<std::vector<double>> counts(double accuracy) const;

 private:
  struct Hash {
    std::size_t operator()(const Eigen::Vector3i& voxel) const;
  };
  /** The labels of a voxel, one from each scan, a byte each. */
  using Labels = std::string;

  double m_voxelSize;
  int m_numClasses;
  std::unordered_map<Eigen::Vector3i, Labels, Hash> m_voxels;
};

}  // namespace labeled_cloud
