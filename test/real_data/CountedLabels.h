#pragma once
#include <semantic_octree/Keys.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_types/ClassTable.h>

#include <array>
#include <map>
#include <random>

#include "LabeledFrame.h"

using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kNoClass;

/** A class table of config/classes. */
ClassTable shippedTable(const std::string& name);

/** Replaces this share of the classes by another one at random. */
void disturb(std::vector<ClassId>& classes, double share, int numClasses, std::mt19937& random);

using Voxel = std::array<int, 3>;

/** The keys of the voxel that a frame's point lies in. */
Voxel voxelOf(const SemanticOcTree& map, const LabeledFrame& frame, std::size_t point);
inline octomap::OcTreeKey keyOf(const Voxel& voxel) {
  return semantic_octree::octomapKey(voxel[0], voxel[1], voxel[2]);
}

/** Labels by voxel, added up: the plainest map of classes. */
class CountedLabels {
 public:
  void add(const Voxel& voxel, ClassId id) {
    if (id != kNoClass) ++m_counts[voxel][id];
  }
  std::vector<Voxel> voxels() const {
    std::vector<Voxel> all;
    for (const auto& [voxel, counts] : m_counts) all.push_back(voxel);
    return all;
  }
  bool has(const Voxel& voxel) const { return m_counts.count(voxel) > 0; }
  /** The most frequent one, the lowest id on a tie; kNoClass where there is none. Labels of voxels
   * across a face count `neighborWeight`. */
  ClassId at(const Voxel& voxel, double neighborWeight = 0) const;

 private:
  std::map<Voxel, std::map<ClassId, int>> m_counts;
};
