#pragma once
#include <map>

#include "PlainMap.h"
#include "RandomScans.h"

/** The distributions of all known voxels: K + 1 probabilities, [0] = free. */
inline std::map<VoxelId, std::vector<double>> voxelsOf(const semantic_octree::SemanticOcTree& map) {
  std::map<VoxelId, std::vector<double>> voxels;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    const octomap::OcTreeKey first = leaf.getIndexKey();
    const int edge = semantic_octree::edgeAtDepth(static_cast<int>(leaf.getDepth()));
    const std::vector<double> p = map.distribution(*leaf);
    for (int x = 0; x < edge; ++x)
      for (int y = 0; y < edge; ++y)
        for (int z = 0; z < edge; ++z)
          voxels[voxelAt(first[0] + x, first[1] + y, first[2] + z)] = p;
  }
  return voxels;
}

/** Meters. */
inline Eigen::Vector3d centerOf(const VoxelId& id, double resolution) {
  return resolution * (Eigen::Vector3d(id[0], id[1], id[2]).array() + 0.5);
}
