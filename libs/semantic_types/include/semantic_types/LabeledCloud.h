#pragma once
#include <semantic_types/ClassTable.h>
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace semantic_types {

/** Points of one scan in the sensor's frame, each with a class or without.
 *
 * All vectors have one entry per point, except those that are empty. */
struct LabeledCloud {
  /** N points, meters, sensor frame. Points that are not finite are skipped where used. */
  std::vector<Eigen::Vector3f> points;
  /** N class ids, kNoClass = the point counts for occupancy only. Empty: no point has a class. */
  std::vector<ClassId> classes;
  /** Soft labels, N x K row-major, each row sums to 1 (all zero: no class). Empty: `classes` holds.
   */
  std::vector<float> probabilities;

  std::size_t size() const { return points.size(); }
  bool empty() const { return points.empty(); }
  void clear() { points.clear(), classes.clear(), probabilities.clear(); }
};

}  // namespace semantic_types
