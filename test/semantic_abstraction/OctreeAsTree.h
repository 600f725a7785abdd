#pragma once
#include <reference/GTreeSearch.h>
#include <semantic_abstraction/Abstraction.h>

#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "FollowedTree.h"

/** A semantic octree for the reference's search: an independent way to its compressed tree, with
 * distributions of all classes, logarithms of the standard library, and no bookkeeping. */
class OctreeAsTree {
 public:
  struct Place {
    semantic_octree::SemanticOcTreeNode node;  ///< none: unknown space
    int depth;
    Eigen::Array3i index;

    LeafId id() const {
      const int edge = semantic_octree::edgeAtDepth(depth);
      const Eigen::Array3i middle = index * edge + edge / 2;
      return {middle.x(), middle.y(), middle.z(), static_cast<unsigned>(depth)};
    }
  };
  using Density = std::function<double(const Eigen::Vector3d&)>;  ///< of a place in the map, m

  reference::Forest forest;
  std::vector<Place> places;  ///< of the forest's nodes

  /** \param rootDepth of the roots; 0: the whole map is one tree \param blockDepth above it unknown
   * space weighs nothing \param density of voxels, at their centers; none: 1 */
  OctreeAsTree(const semantic_octree::SemanticOcTree& map, int rootDepth, int blockDepth,
               Density density = {})
      : m_map(map), m_blockDepth(blockDepth), m_density(std::move(density)) {
    if (map.root()) addBelow({map.root(), 0, {0, 0, 0}}, rootDepth);
  }

  /** The known leaves among some nodes. */
  std::set<LeafId> knownAmong(const std::vector<std::int32_t>& nodes) const {
    std::set<LeafId> ids;
    for (const std::int32_t n : nodes)
      if (places[n].node) ids.insert(places[n].id());
    return ids;
  }

 private:
  /** The roots below a place above them. */
  void addBelow(const Place& place, int rootDepth) {
    if (place.depth == rootDepth) return add(place, reference::Forest::kNoParent);
    for (int i = 0; i < 8 && !place.node->isLeaf(); ++i)
      if (const Place c = child(place, i); c.node) addBelow(c, rootDepth);
  }
  void add(const Place& place, std::int32_t parent) {
    places.push_back(place);
    if (!place.node) {
      std::vector<double> unknown(m_map.numClasses() + 1, 0.0);
      unknown.push_back(1);  // a class of its own
      forest.addMissing(parent, place.depth > m_blockDepth ? volume(place) : 0, unknown);
    } else if (place.node->isLeaf()) {
      std::vector<double> p = m_map.distribution(*place.node);
      p.push_back(0);
      forest.addLeaf(parent, volume(place), p);
    } else {
      const std::int32_t inner = forest.addInner(parent);
      for (int i = 0; i < 8; ++i) add(child(place, i), inner);
    }
  }
  double volume(const Place& place) const {
    return std::ldexp(1.0, -3 * place.depth) * (m_density ? meanDensity(place) : 1.0);
  }
  double meanDensity(const Place& leaf) const {
    const int edge = semantic_octree::edgeAtDepth(leaf.depth), half = 1 << 15;
    double sum = 0;
    for (int x = 0; x < edge; ++x)
      for (int y = 0; y < edge; ++y)
        for (int z = 0; z < edge; ++z) {
          const Eigen::Array3i voxel = leaf.index * edge + Eigen::Array3i(x, y, z);
          sum += m_density((voxel.cast<double>() + 0.5 - half).matrix() * m_map.getResolution());
        }
    return sum / edge / edge / edge;
  }
  static Place child(const Place& place, int i) {
    return {place.node->child(i), place.depth + 1,
            2 * place.index + Eigen::Array3i(i & 1, i >> 1 & 1, i >> 2)};
  }

  const semantic_octree::SemanticOcTree& m_map;
  int m_blockDepth;
  Density m_density;
};
