#pragma once
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_octree/store/Cell.h>

#include <optional>

namespace semantic_octree {

/** Density of p(x) over space: 1, or the largest weight of the regions that a voxel's center is in.
 * A cell's is the mean over its voxels, exactly, so that cells add up to their parent. */
class DensityField {
 public:
  DensityField() = default;
  DensityField(std::vector<Region> regions, double resolution);

  double mean(const Cell& cell) const { return m_regions.empty() ? 1.0 : meanInRegions(cell); }
  /** The density of all of the cell, unless a border between densities may cross it. */
  std::optional<double> constantIn(const Cell& cell) const {
    return m_regions.empty() ? 1.0 : constantInRegions(cell);
  }

 private:
  friend class DensityChange;
  enum class Overlap { None, Part, Full };
  Overlap overlap(const Region& region, const Cell& cell) const;
  std::optional<double> constantInRegions(const Cell& cell) const;
  double meanInRegions(const Cell& cell) const;

  std::vector<Region> m_regions;
  double m_resolution = 1;
};

/** What becomes of the density when regions move. */
class DensityChange {
 public:
  /** Compares fields of maps of one resolution, which must outlive this. */
  DensityChange(const DensityField& before, const DensityField& now);

  /** Whether there is none anywhere in a cell, as far as can be told without going to its voxels:
   * true is certain. */
  bool noneIn(const Cell& cell) const;

 private:
  const DensityField& m_before;
  const DensityField& m_now;
  DensityField m_moved;  ///< the regions that only one of them has
};

}  // namespace semantic_octree
