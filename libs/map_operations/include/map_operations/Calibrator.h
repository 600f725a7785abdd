#pragma once
#include <semantic_octree/InsertionOptions.h>
#include <semantic_octree/SemanticOcTree.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace semantic_octree {

/** Finds out what labels are worth, from labels alone, and fits what a map states to it.
 *
 * Voxels keep the label of each scan that saw them. Expectation maximization finds how often which
 * class is taken for which, and what each voxel is (Dawid and Skene, "Maximum Likelihood Estimation
 * of Observer Error-Rates Using the EM Algorithm", 1979). Labels may repeat those of earlier scans:
 * then, if the first two of three labels differ, the third is more often the second than the first.
 * What all scans repeat cannot be seen in one voxel, and is taken to be at least that one of two
 * scans repeats the one before. It is seen beside it: a place that is taken for another class has
 * an edge, in one scan or in all.
 *
 * One voxel in 4 keeps its labels, fewer in large maps: about 32 thousand voxels, 64 labels each.
 * Only additions, multiplications and divisions are made, so that results are the same bits
 * everywhere. */
class Calibrator {
 public:
  /** \param voxelSize meters, as the map's \param numClasses K >= 1 */
  Calibrator(double voxelSize, int numClasses) : m_voxelSize(voxelSize), m_numClasses(numClasses) {}

  /** A scan's labels, of soft ones the likeliest class: each voxel has that of most of its points,
   * the lowest id on a tie. \param options as it is inserted
   * \throw std::invalid_argument vectors of different lengths. */
  void add(const LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
           const InsertionOptions& options = {});
  /** Forgets where labels were: the map has moved. */
  void clear() { m_voxels.clear(); }

  /** What makes -sum_k q_k ln(stated p(class k | occupied)) least over the voxels, q_k what their
   * labels say, each counting by its points. What the map has counts like 100 labels; labels count
   * from the third of a voxel on, for fewer cannot outvote each other. Power and share are in steps
   * of 1/256. Classes get factors where labels err: where the first two labels of more than one
   * voxel in 25 differ, and no border of the two is beside. Not if the map was told how frequent
   * classes are (FilterParameters::classPrior). Where labels err, places may be wrong in all scans,
   * too: edges between voxels tell how often. */
  Calibration fit(const SemanticOcTree& map) const { return fitLater(map)(); }
  /** fit() in two parts: the map is read at once. The rest, which takes most of the time, is done
   * by whoever calls what is returned, in any thread. */
  std::function<Calibration()> fitLater(const SemanticOcTree& map) const;
  /** K x K expected counts for a confusion matrix: row is the true class, column the label. Beside
   * what was seen, 1000 labels of each class are right with probability `accuracy`, (1/K, 1). */
  std::vector<std::vector<double>> confusion(double accuracy) const;

 private:
  bool keeps(std::uint64_t voxel) const;
  void keepFewer();
  /** Labels of the voxels that several scans saw. */
  std::map<std::string, double> seenAgain() const;
  /** Whether labels of a voxel differ more often than borders of right ones do. */
  bool labelsErr(const SemanticOcTree& map) const;

  double m_voxelSize;
  int m_numClasses;
  std::uint64_t m_oneIn = 1;  ///< voxels keeps its labels
  /** By their key, 16 bits for each axis: labels, one of each scan, a byte each. */
  std::unordered_map<std::uint64_t, std::string> m_voxels;
};

}  // namespace semantic_octree
