#pragma once
#include <semantic_slam/PoseGraph.h>
#include <semantic_types/LabeledCloud.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace semantic_slam {

using semantic_types::LabeledCloud;

/** Points in cubes: of each cube, and of each class in it, mean and covariance. */
class Submap {
 public:
  /** \param cellSize edge of a cube, meters \param useClasses false: all points are of one class
   * \param isPlanar points are of horizontal beams: they are compared in x and y alone, and lines
   * of them are walls, as thin as they seem */
  Submap(double cellSize, bool useClasses, bool isPlanar = false)
      : m_cellSize(cellSize), m_useClasses(useClasses), m_isPlanar(isPlanar) {}

  /** \param deviation standard deviation of each point, along each axis, m */
  void add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_submap_cloud,
           double deviation = 0);
  /** Computes the distributions of cubes to which points were added. */
  void finish();

  struct Distribution {
    Eigen::Vector3d mean;
    Eigen::Matrix3d information;  ///< inverse covariance, 1/m^2
    /** What of it is not due to the cube: along its axes, less 12 / edge^2, that of points all over
     * the cube, and at least 0. A surface that goes on beyond says nothing along itself. */
    Eigen::Matrix3d evidence;
  };
  /** The likeliest for a point of its class, in its cube and the six beside; null: there is none.
   */
  const Distribution* find(const Eigen::Vector3d& point, semantic_types::ClassId id,
                           double& squaredDistance) const;
  double cellSize() const { return m_cellSize; }

 private:
  struct Sum {
    double n = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    bool isNew = false;  ///< something was added since finish()
  };
  using Key = std::uint64_t;
  Key keyOf(const Eigen::Array3i& cell, semantic_types::ClassId id) const;
  Eigen::Array3i cellOf(const Eigen::Vector3d& point) const;
  /** Mean relative to the cube. */
  Distribution distributionOf(const Sum& sum) const;

  double m_cellSize;
  bool m_useClasses, m_isPlanar;
  std::unordered_map<Key, Sum> m_sums;
  std::vector<Key> m_new;  ///< of sums that are new
  std::unordered_map<Key, Distribution> m_distributions;
};

/** Whether all beams are, as the robot stands. \param cloud sensor frame */
bool isHorizontal(const LabeledCloud& cloud, const Eigen::Isometry3d& T_robot_sensor);

/** One point per cube, drawn from those in it, each as likely (Vitter, "Random Sampling with a
 * Reservoir"), the same each time; none beyond a range. The first ones would be biased: where an
 * image's rows enter a cube of ground, those are left that noise brings nearer, that is up.
 * \param cubeSize, maxRange meters */
LabeledCloud thinned(const LabeledCloud& cloud, double cubeSize, double maxRange);

struct Registration {
  Eigen::Isometry3d T_submap_scan;
  Matrix6 information;      ///< as PoseEdge's, by the points that fit, each off by itself
  double coveredShare = 0;  ///< of the points, those where the submap has points of their class
  double matchedShare = 0;  ///< of these, those within three standard deviations
};

/** Where a scan was taken, by what others saw: the distances of its points to the distributions of
 * their classes become least (P2D-NDT: Magnusson, "The Three-Dimensional Normal-Distributions
 * Transform"; with classes as in Zaganidis et al., "Integrating Deep Semantic Segmentation into 3-D
 * Point Cloud Registration"), Gauss-Newton with Geman and McClure's weights.
 * \param submaps of the same points, coarse ones first; each begins where the one before ended
 * \param prior information of the guess, frame of the scan */
Registration registerScan(const std::vector<const Submap*>& submaps, const LabeledCloud& scan,
                          const Eigen::Isometry3d& T_submap_guess,
                          const Matrix6& prior = Matrix6::Zero());

}  // namespace semantic_slam
