#pragma once
#include <semantic_octree/Keys.h>

#include <array>
#include <map>
#include <optional>
#include <set>

#include "ExactFilter.h"
#include "SmallScans.h"

/** Voxel coordinates: floor(coordinate / resolution). */
using VoxelId = std::array<int, 3>;

inline octomap::OcTreeKey keyOf(const VoxelId& v) {
  constexpr int origin = semantic_octree::kKeyOfOrigin;
  return semantic_octree::octomapKey(v[0] + origin, v[1] + origin, v[2] + origin);
}
/** The voxel that has these keys. */
inline VoxelId voxelAt(int x, int y, int z) {
  constexpr int origin = semantic_octree::kKeyOfOrigin;
  return {x - origin, y - origin, z - origin};
}

/** What a scan says of space, found ray by ray and point by point. */
struct PlainScan {
  std::map<VoxelId, std::vector<std::size_t>> hits;  ///< points that end in the voxel
  std::set<VoxelId> free;
};
PlainScan plainScan(const PosedCloud& scan, double resolution,
                    const semantic_octree::InsertionOptions& options);

/** A map without a tree: every voxel on its own, one insertion after the other. Slow and simple. */
class PlainMap {
 public:
  struct Voxel {
    float value = 0;  ///< occupancy, log-odds
    std::optional<semantic_octree::ClassBelief> record;
  };

  PlainMap(double resolution, int K, const semantic_octree::FilterParameters& parameters = {})
      : m_resolution(resolution), m_parameters(parameters), m_filter(K, parameters) {}
  void insert(const PosedCloud& scan, const semantic_octree::InsertionOptions& options);

  const std::map<VoxelId, Voxel>& voxels() const { return m_voxels; }
  double resolution() const { return m_resolution; }
  int numClasses() const { return m_filter.numClasses(); }

 private:
  /** Labels voxel by voxel, held against what the parameters expect. */
  semantic_octree::LabelReliability reliabilityOf(const PlainScan& plain,
                                                  const semantic_types::LabeledCloud& cloud) const;
  Voxel& voxel(const VoxelId& id);
  void hit(Voxel& v, const std::vector<std::size_t>& points,
           const semantic_types::LabeledCloud& cloud,
           const semantic_octree::ClassFilter& filter) const;
  void hitSoft(Voxel& v, const std::vector<std::size_t>& points,
               const semantic_types::LabeledCloud& cloud) const;
  void hitUnlabeled(Voxel& v) const;
  void miss(Voxel& v) const;

  double m_resolution;
  semantic_octree::FilterParameters m_parameters;
  semantic_octree::ClassFilter m_filter;
  std::map<VoxelId, Voxel> m_voxels;
};

/** Expects that a tree holds the same voxels with the same values and records, to the last bit. */
void expectSame(const semantic_octree::SemanticOcTree& tree, const PlainMap& plain);
