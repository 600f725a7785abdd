#pragma once
#include <map>

#include "PlainMap.h"
#include "RandomScans.h"

/** The distributions of all known voxels: K + 1 probabilities, [0] = free. */
inline std::map<VoxelId, std::vector<double>> voxelsOf(const semantic_octree::SemanticOcTree& map) {
  std::map<VoxelId, std::vector<double>> voxels;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    const octomap::OcTreeKey first = leaf.getIndexKey();
    const int edge = 1 << (16 - leaf.getDepth());
    const std::vector<double> p = map.distribution(*leaf);
    for (int x = 0; x < edge; ++x)
      for (int y = 0; y < edge; ++y)
        for (int z = 0; z < edge; ++z)
          voxels[{first[0] + x - 32768, first[1] + y - 32768, first[2] + z - 32768}] = p;
  }
  return voxels;
}

/** Meters. */
inline Eigen::Vector3d centerOf(const VoxelId& id, double resolution) {
  return resolution * (Eigen::Vector3d(id[0], id[1], id[2]).array() + 0.5);
}
