#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <random>
#include <tuple>

#include "Classes.h"

using CubeId = std::tuple<int, int, int, int>;  // keys of the lowest voxel, depth

inline CubeId cubeOf(const Eigen::Array3i& lowest, int depth) {
  return {lowest.x(), lowest.y(), lowest.z(), depth};
}

inline semantic_types::ClassTable threeClasses() {
  return tableOf({{"road", {200, 30, 30}}, {"tree", {30, 180, 60}}, {"wall", {40, 60, 210}}});
}

/** Voxels of 0.2 m: ground of road and trees with a wall, seen from above the map's origin, with
 * holes and wrong labels. */
inline semantic_octree::SemanticOcTree randomMap(unsigned seed, int numScans = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  semantic_octree::SemanticOcTree tree(0.2, threeClasses());
  for (int scan = 0; scan < numScans; ++scan) {
    semantic_types::LabeledCloud cloud;
    for (int i = 0; i < 6000; ++i) {
      const float x = 24 * unit(random) - 12, y = 24 * unit(random) - 12;
      const bool wall = std::abs(x - 5) < 0.3f;
      cloud.points.emplace_back(x, y, wall ? 3 * unit(random) - 4 : -4 + 0.3f * unit(random));
      semantic_types::ClassId id = wall ? 3 : y > 0 ? 2 : 1;
      if (unit(random) < 0.1f) id = static_cast<semantic_types::ClassId>(1 + random() % 3);
      cloud.classes.push_back(id);
    }
    Eigen::Isometry3d T_map_sensor(Eigen::Translation3d(scan, 0, 4));
    tree.insert(cloud, T_map_sensor);
  }
  return tree;
}

/** Keys of an occupied voxel of a class, not pruned. */
inline Eigen::Array3i voxelOfClass(const semantic_octree::SemanticOcTree& map,
                                   semantic_types::ClassId id) {
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf)
    if (leaf.getDepth() == 16 && map.isNodeOccupied(*leaf) && map.query(*leaf).likeliestClass == id)
      return {leaf.getKey()[0], leaf.getKey()[1], leaf.getKey()[2]};
  throw std::logic_error("no such voxel");
}
