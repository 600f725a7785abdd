#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <Eigen/Core>

#include <vector>

namespace semantic_octree {

/** How much the voxels around it tell about a voxel's class. */
struct SmoothingOptions {
  /** Weight of what a voxel that shares a face tells, beside 1 for the voxel itself; none tells
   * more than odds of 25. Straight borders between classes stay whatever the weight. Below 0.25 a
   * single voxel as sure as its four neighbors of another class keeps its class. 0: each voxel for
   * itself.
   *
   * For voxels in which no label was seen their 26 neighbors answer: across an edge with half the
   * weight, across a corner with a quarter. */
  double neighborWeight = 1;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** A map whose voxels' classes are seen together with their neighbors' (a spatial kernel, as in
 * Gan et al., "Bayesian Spatial Kernel Smoothing for Scalable Dense Semantic Mapping", and
 * ConvBKI). Here it is at the query: the map stays the exact filter of its scans, the weight can
 * change.
 *
 * With h_k the log-odds that the filter believes of a voxel's classes, less those of the likeliest,
 *
 *     g_k = (h_k(voxel) + weight sum_n max(h_k(n), -3.2)) / (1 + repeated (W - 1)).
 *
 * A neighbor tells no more than odds of 25 = e^3.2, for a border may lie between. W is the sum of
 * the weights, at least 1: 1 for the voxel, `weight` for a neighbor, in proportion less if its
 * log-odds range over more than 3.2. Voxels without a label tell nothing and have no
 * weight. No class falls farther behind the likeliest than the filter's limits let it in one voxel.
 * What is stated follows from g as the map's own follows from h, with the map's Calibration:
 * classes share what the voxel's own record names. Where classes have factors, 2.2 takes the place
 * of 3.2, and factors are raised to the root of W over the divisor. A factor is both how frequent a
 * class is, which counts once, and for what its labels are taken, which counts with each voxel.
 *
 * A sum is right if neighbors err by themselves (repeated = 0), a mean if they all err alike
 * (repeated = 1). The map tells which it is: who learns more believes, in the mean, what was
 * believed before. So with this `repeated` a voxel's own surest class is as likely with neighbors
 * as without, in the mean over occupied voxels. Occupancy and status are the voxel's own.
 *
 * For maps of voxels: in a leaf of a compressed map, which is larger, the same mixture would count
 * several times. The map must outlive the view, and is looked at once, when the view is made, for
 * `repeated`. Safe from several threads while the map does not change. */
class SmoothedView {
 public:
  /** \throw std::invalid_argument bad options. */
  explicit SmoothedView(const SemanticOcTree& map, const SmoothingOptions& options = {});

  /** As SemanticOcTree::query(), but free and unknown voxels may have a likeliest class, too: the
   * one they would have if occupied. */
  CellState query(const octomap::OcTreeKey& key) const;
  /** Asks the voxel that contains a point (meters, map frame). */
  CellState query(double x, double y, double z) const;
  /** K + 1 probabilities, [0] = free space; of a voxel of which nothing is known: 1/2, and the
   * classes equally likely. */
  std::vector<double> distribution(const octomap::OcTreeKey& key) const;
  /** Asks the voxel that contains a point (meters, map frame).
   * \throw std::out_of_range the point is outside the map. */
  std::vector<double> distribution(double x, double y, double z) const;

 private:
  struct Heard;
  /** K probabilities, given that the voxel is occupied; empty: no voxel of those asked has a label.
   */
  std::vector<double> classes(const octomap::OcTreeKey& key) const;
  Heard listen(const Eigen::Array3i& voxel, double weight) const;
  std::vector<double> stated(const Heard& heard, double repeated) const;
  double repeatedInMap() const;

  const SemanticOcTree& m_map;
  SmoothingOptions m_options;
  double m_mostBehind;    ///< the likeliest class
  double m_repeated = 1;  ///< of what one voxel tells by its neighbors
};

}  // namespace semantic_octree
