#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_types/ClassTable.h>

#include <map>
#include <unordered_map>

#include "LabeledFrame.h"

using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kNoClass;

/** A class table of config/classes. */
ClassTable shippedTable(const std::string& name);

using Voxel = octomap::OcTreeKey;
template <typename T>
using ByVoxel = std::unordered_map<Voxel, T, Voxel::KeyHash>;

/** The voxel that a frame's point lies in. */
Voxel voxelOf(const SemanticOcTree& map, const LabeledFrame& frame, std::size_t point);

/** Labels by voxel, added up: the plainest map of classes. */
class CountedLabels {
 public:
  void add(const Voxel& voxel, ClassId id) {
    if (id != kNoClass) ++m_counts[voxel][id];
  }
  const ByVoxel<std::map<ClassId, int>>& voxels() const { return m_counts; }
  /** The most frequent one, the lowest id on a tie; kNoClass where there is none. Labels of voxels
   * across a face count `neighborWeight`. */
  ClassId at(const Voxel& voxel, double neighborWeight = 0) const;

 private:
  ByVoxel<std::map<ClassId, int>> m_counts;
};
