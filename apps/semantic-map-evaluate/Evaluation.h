#pragma once
#include <map_operations/SmoothedView.h>
#include <octomap/OcTreeKey.h>
#include <semantic_types/LabeledCloud.h>
#include <Eigen/Geometry>

#include <array>
#include <unordered_map>
#include <utility>
#include <vector>

namespace semantic_map_evaluate {

/** How often a map is right about labeled points, and how often it says so. */
class Evaluation {
 public:
  /** What is said of a point's voxel. */
  struct Answer {
    bool isOccupied = false;
    semantic_octree::ClassId likeliest = semantic_octree::kNoClass;
    double ofLikeliest = 0, ofTruth = 0;  ///< p(class | occupied)
  };
  /** Points that were answered for with a probability of some range. */
  struct Bin {
    std::size_t points = 0, right = 0;
    double stated = 0;  ///< sum of the probabilities

    double meanStated() const { return stated / static_cast<double>(points); }
    double shareRight() const { return static_cast<double>(right) / static_cast<double>(points); }
  };
  static constexpr std::size_t kBins = 20;

  explicit Evaluation(int numClasses) : m_ofClass(numClasses + 1) {}

  /** Asks for the class of a point (meters, map frame) that is known to be of class `truth`. */
  void ask(const semantic_octree::SmoothedView& view, const Eigen::Vector3d& point,
           semantic_octree::ClassId truth);
  void add(const Answer& answer, semantic_octree::ClassId truth);

  std::size_t points() const { return m_points; }
  /** The share of all points that lie in occupied voxels. */
  double coverage() const { return share(m_occupied, m_points); }
  /** The share of all points whose voxel names their class, occupied or not. */
  double rightOfAll() const { return share(m_right, m_points); }

  /** Points in occupied voxels that name a class. What follows is about them. */
  std::size_t answered() const { return m_answered.points; }
  double accuracy() const { return share(m_answered.right, m_answered.points); }
  /** Mean over the classes that occur of the share of their points that is right. */
  double meanRecall() const;
  /** Mean of p(likeliest class | occupied). */
  double meanStated() const { return m_answered.meanStated(); }
  /** Mean of -ln p(true class | occupied), nats. */
  double logLoss() const { return m_logLoss / static_cast<double>(m_answered.points); }
  /** Mean difference of what is stated, p(likeliest class | occupied), and the share that is right,
   * over the bins by their points. */
  double calibrationError() const;
  /** By what is stated, from 0 to 1. */
  const std::array<Bin, kBins>& reliability() const { return m_bins; }
  /** By the true class, [0] is empty. */
  const std::vector<Bin>& ofClass() const { return m_ofClass; }

 private:
  static double share(std::size_t part, std::size_t of) {
    return static_cast<double>(part) / static_cast<double>(of);
  }

  std::size_t m_points = 0, m_occupied = 0, m_right = 0;
  Bin m_answered;
  double m_logLoss = 0;
  std::array<Bin, kBins> m_bins{};
  std::vector<Bin> m_ofClass;
};

/** What maps are held against: the labels in each voxel, counted. Of n labels n_k are of class k,
 * one of K classes: p(class k) = (n_k + a/K) / (n + a). That is the mean of a Dirichlet
 * distribution whose prior counts like a = 0.1 labels. */
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
