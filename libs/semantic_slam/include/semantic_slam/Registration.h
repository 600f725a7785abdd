#pragma once
#include <semantic_slam/PoseGraph.h>
#include <semantic_types/LabeledCloud.h>

#include <array>
#include <cstdint>
#include <vector>

namespace semantic_slam {

using semantic_types::LabeledCloud;

/** Numbers keys, which are less than the largest one, in the order in which they come. */
class KeyNumbers {
 public:
  using Key = std::uint64_t;
  static constexpr std::uint32_t kNone = UINT32_MAX;

  /** A new key gets the next number. */
  std::uint32_t add(Key key);
  /** kNone: it was not added. */
  std::uint32_t find(Key key) const { return m_slots[slotOf(key)].number; }
  std::size_t size() const { return m_size; }

 private:
  struct Slot {
    Key key = UINT64_MAX;
    std::uint32_t number = kNone;
  };
  /** That of the key, or where it would be. */
  std::size_t slotOf(Key key) const;

  std::vector<Slot> m_slots =
      std::vector<Slot>(16);  ///< a power of two, at most half of them taken
  std::uint32_t m_size = 0;
};

/** Points in cubes: of each cube, and of each class in it, mean and covariance. */
class Submap {
 public:
  /** \param cellSize edge of a cube, meters \param useClasses false: all points are of one class
   * \param isPlanar points are of horizontal beams: they are compared in x and y alone, and lines
   * of them are walls, as thin as they seem */
  Submap(double cellSize, bool useClasses, bool isPlanar = false)
      : m_cellSize(cellSize),
        m_perMeter(1 / cellSize),
        m_useClasses(useClasses),
        m_isPlanar(isPlanar) {}

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
  /** Distributions of a point's class, in its cube and in the six beside. */
  struct Near {
    KeyNumbers::Key key = UINT64_MAX;  ///< of the cube
    int size = 0;
    std::array<const Distribution*, 7> distributions;

    /** The likeliest for a point; null: there is none. */
    const Distribution* find(const Eigen::Vector3d& point, double& squaredDistance) const;
  };
  /** \param near new, or of a point of this submap before: nothing is done if the cube is the same.
   * Valid until add() */
  void look(const Eigen::Vector3d& point, semantic_types::ClassId id, Near& near) const;
  /** The likeliest for a point of its class, in its cube and the six beside; null: there is none.
   */
  const Distribution* find(const Eigen::Vector3d& point, semantic_types::ClassId id,
                           double& squaredDistance) const {
    Near near;
    look(point, id, near);
    return near.find(point, squaredDistance);
  }
  double cellSize() const { return m_cellSize; }
  bool isPlanar() const { return m_isPlanar; }

 private:
  using Key = KeyNumbers::Key;
  /** Sums over the points of a class in a cube. */
  struct Sum {
    double n = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  };
  struct Cell {
    bool isNew = false;  ///< something was added since finish()
    bool isEnough = false;
    semantic_types::ClassId id;
    Eigen::Array3i cube;
    Distribution distribution;  ///< if there are enough points
    Sum sum;
  };
  Key keyOf(const Eigen::Array3i& cube, semantic_types::ClassId id) const;
  Eigen::Array3i cubeOf(const Eigen::Vector3d& point) const;
  /** It is new from now on. */
  Cell& cellOf(const Eigen::Array3i& cube, semantic_types::ClassId id);
  /** Mean relative to the cube. */
  Distribution distributionOf(const Sum& sum) const;

  double m_cellSize, m_perMeter;  // m; cubes
  bool m_useClasses, m_isPlanar;
  KeyNumbers m_numbers;
  std::vector<Cell> m_cells;
  std::vector<std::uint32_t> m_new;  ///< cells that are
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
 * their classes become least, by Gauss-Newton with Geman and McClure's weights. (P2D-NDT:
 * Magnusson, "The Three-Dimensional Normal-Distributions Transform"; with classes as in Zaganidis
 * et al., "Integrating Deep Semantic Segmentation into 3-D Point Cloud Registration".) One point is
 * taken of each cube. It is half as large as the finest submap's, or as the next finer one's for a
 * coarser submap. Scans in a plane are taken whole.
 * \param submaps of the same points, coarse ones first; each begins where the one before ended
 * \param prior information of the guess, frame of the scan */
Registration registerScan(const std::vector<const Submap*>& submaps, const LabeledCloud& scan,
                          const Eigen::Isometry3d& T_submap_guess,
                          const Matrix6& prior = Matrix6::Zero());

}  // namespace semantic_slam
