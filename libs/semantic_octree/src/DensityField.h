#pragma once
#include <semantic_octree/AbstractionOptions.h>

#include "Cell.h"

namespace semantic_octree {

/** Density of p(x) over space: 1, or the largest weight of the regions that a voxel's center is in.
 * A cell's is the mean over its voxels, exactly, so that cells add up to their parent. */
class DensityField {
 public:
  DensityField() = default;
  DensityField(std::vector<Region> regions, double resolution);

  bool isUniform() const { return m_regions.empty(); }
  double mean(const Cell& cell) const { return m_regions.empty() ? 1.0 : meanInRegions(cell); }
  /** Whether the two fields have the same density everywhere in a cell, as far as can be told
   * without going to its voxels: true is certain. */
  static bool sameIn(const DensityField& a, const DensityField& b, const Cell& cell);

 private:
  enum class Overlap { None, Part, Full };
  Overlap overlap(const Region& region, const Cell& cell) const;
  double meanInRegions(const Cell& cell) const;
  /** Whether no region's border crosses the cell; then `density` is that of all of it. */
  bool constantIn(const Cell& cell, double& density) const;

  std::vector<Region> m_regions;
  double m_resolution = 1;
};

}  // namespace semantic_octree
