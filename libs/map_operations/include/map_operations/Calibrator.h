#pragma once
#include <semantic_octree/InsertionOptions.h>
#include <semantic_octree/SemanticOcTree.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace semantic_octree {

/** Fits what a map states to scans that it does not know yet: a scan's labels ask the map for the
 * classes of their voxels before the scan is inserted, and the calibration is the mean of a grid of
 * them, weighted by how likely each made all labels so far (Dawid, "The Prequential Approach",
 * 1984).
 *
 * A label names its voxel's class with probability a, and any other class with (1 - a) / (K - 1),
 *
 *   p(label k) = a s_k + (1 - a) (1 - s_k) / (K - 1),   s = what is stated (see Calibration),
 *
 * and a is fitted, too: labels that err one by one lower a, and the map may be sure nevertheless.
 * Errors that all scans repeat cannot be seen this way.
 *
 * One voxel in 16 asks, with one label a scan, once three scans saw it: fewer cannot outvote each
 * other. */
class Calibrator {
 public:
  /** Before a scan is inserted. \param T_map_sensor, options as it will be
   * \throw std::invalid_argument vectors of different lengths. */
  void ask(const SemanticOcTree& map, const LabeledCloud& cloud,
           const Eigen::Isometry3d& T_map_sensor, const InsertionOptions& options = {});
  /** What was fitted, in steps of 1/64; what the map had at first until labels speak against it. */
  Calibration best() const;

 private:
  /** A label, and what the map believes of its voxel. */
  struct Question {
    SemanticOcTree::Belief belief;
    std::array<double, 3> named;  ///< p(label is this named class): 0 or 1, but of soft labels
    double others;                ///< the same of all classes that are not named
  };
  void begin(const SemanticOcTree& map);
  void add(const std::vector<Question>& questions, int numClasses);

  struct Seen {
    std::uint32_t scans = 0, last = 0;
  };
  std::unordered_map<octomap::OcTreeKey, Seen, octomap::OcTreeKey::KeyHash> m_voxels;
  std::uint32_t m_scans = 0;
  /** For each calibration and a: -ln p of all labels, 1/1024 nat. */
  std::vector<std::int64_t> m_losses;
};

}  // namespace semantic_octree
