#pragma once
#include <reference/GTreeSearch.h>
#include <semantic_abstraction/Abstraction.h>

#include <cmath>
#include <functional>
#include <vector>

/** A semantic octree as the reference's search sees a tree: an independent way to its
 * compressed tree, with distributions of all classes, logarithms of the standard library, and no
 * bookkeeping.
 *
 * Nodes at `rootDepth` are the roots (0: the whole map is one tree); unknown space weighs
 * `unknownWeight` times its volume below `rootDepth`, nothing above it. Voxels weigh what a density
 * says of their centers, if there is one. */
class OctreeAsTree {
 public:
  struct Node {
    semantic_octree::SemanticOcTreeNode node;  ///< none: unknown space
    int depth;
    std::array<int, 3> index;
  };

  using Density = std::function<double(const Eigen::Vector3d&)>;  ///< of a place in the map, m

  OctreeAsTree(const semantic_octree::SemanticOcTree& map, int rootDepth, int blockDepth,
               double unknownWeight = 1, Density density = {})
      : m_map(map),
        m_rootDepth(rootDepth),
        m_blockDepth(blockDepth),
        m_unknownWeight(unknownWeight),
        m_density(std::move(density)) {}

  /** Unknown space is class K + 1. */
  int numClasses() const { return m_map.numClasses() + 1; }
  bool isKnown(const Node& leaf) const { return static_cast<bool>(leaf.node); }
  double weight(const Node& leaf) const {
    const double volume = std::ldexp(1.0, -3 * leaf.depth) * (m_density ? meanDensity(leaf) : 1.0);
    if (leaf.node) return volume;
    return leaf.depth > m_blockDepth ? m_unknownWeight * volume : 0.0;
  }
  void distribution(const Node& leaf, std::vector<double>& p) const {
    if (leaf.node) {
      p = m_map.distribution(*leaf.node);
      p.push_back(0);
    } else {
      p.assign(numClasses() + 1, 0.0);
      p.back() = 1;
    }
  }
  template <class F>
  void forEachRoot(const F& f) const {
    if (m_map.root()) forEachRootBelow({m_map.root(), 0, {0, 0, 0}}, f);
  }
  template <class F>
  void forEachChild(const Node& n, const F& f) const {
    if (!n.node || n.node->isLeaf()) return;
    for (unsigned i = 0; i < 8; ++i) f(child(n, i));
  }

 private:
  double meanDensity(const Node& leaf) const {
    const int edge = semantic_octree::edgeAtDepth(leaf.depth), half = 1 << 15;
    double sum = 0;
    for (int x = 0; x < edge; ++x)
      for (int y = 0; y < edge; ++y)
        for (int z = 0; z < edge; ++z) {
          const Eigen::Array3d voxel(leaf.index[0] * edge + x, leaf.index[1] * edge + y,
                                     leaf.index[2] * edge + z);
          sum += m_density((voxel + 0.5 - half).matrix() * m_map.getResolution());
        }
    return sum / edge / edge / edge;
  }
  Node child(const Node& n, unsigned i) const {
    const int bits[3] = {static_cast<int>(i & 1), static_cast<int>(i >> 1 & 1),
                         static_cast<int>(i >> 2)};
    return {n.node.child(static_cast<int>(i)),
            n.depth + 1,
            {2 * n.index[0] + bits[0], 2 * n.index[1] + bits[1], 2 * n.index[2] + bits[2]}};
  }
  template <class F>
  void forEachRootBelow(const Node& n, const F& f) const {
    if (n.depth == m_rootDepth) return f(n);
    forEachChild(n, [&](const Node& c) {
      if (c.node) forEachRootBelow(c, f);
    });
  }

  const semantic_octree::SemanticOcTree& m_map;
  int m_rootDepth, m_blockDepth;
  double m_unknownWeight;
  Density m_density;
};
