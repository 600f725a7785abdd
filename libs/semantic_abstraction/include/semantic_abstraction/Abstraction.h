#pragma once
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_octree/Cube.h>
#include <semantic_octree/SemanticOcTree.h>
#include <tree_abstraction/AbstractionWeights.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace semantic_octree {

/** \file
 * Words: the abstraction of a map is an optimization, given by weights and alpha
 * (AbstractionOptions). The compressed tree comes out, and compressedMap() is a map of it.
 *
 * From alpha to the leaves: AbstractionOptions -> GTree (src/GTree.h: from the leaves up, G-values)
 * -> CompressedTree (src/CompressedTree.h: from the root down, leaves). */

class CompressedTree;
class GTree;
class LeafLog;

/** A leaf of the compressed tree: a cube of the map. */
struct LeafCell : Cube {
  /** The map's node for the cube, or for a larger cube around it that is a leaf of the map. Valid
   * until the map changes. */
  SemanticOcTreeNode node;
};

/** What the compressed tree keeps of what the whole map tells. Known leaves are nodes, all leaves
 * count unknown space too: a missing child of an inner node is a leaf. */
struct AbstractionMeasures {
  tree_abstraction::TreeMeasures full, compressed;
  /** J of the compressed tree: sum_t weight_t I_t - alpha I_X, counted from the roots of the blocks
   * where the nodes above them are free (nats). */
  double objective = 0;

  /** Share of a term's information that the compressed tree keeps; none where there is none to keep
   * (below 1e-12 nats). */
  std::optional<double> retention(std::size_t term) const;
};

/** What a tree has, or what expanding nodes adds to it. */
struct AddedToTree {
  double leaves = 0;  ///< known ones
  /** Information of the terms of either sign, times the amounts of their weights, nats. */
  double relevant = 0, irrelevant = 0;

  AddedToTree& operator+=(const AddedToTree& o);
};

/** Leaves of the compressed tree that came and went between two looks (LeafFollower::leaves()):
 * cubes without their `node`. */
struct TreeChange {
  /** What came is all that there is. What the reader knew before does not count. */
  bool all = false;
  std::vector<LeafCell> removed;
  std::vector<LeafCell> added;
};

/** A map keeps the class mixtures and G-values of inner nodes from now on: insert() updates them in
 * the same pass. \throw std::invalid_argument as AbstractionOptions::forClasses(). */
void setAbstraction(SemanticOcTree& map, const AbstractionOptions& options);
/** A map keeps class mixtures and G-values no longer. */
void dropAbstraction(SemanticOcTree& map);
bool hasAbstraction(const SemanticOcTree& map);

/** The abstraction of a map that keeps G-values (setAbstraction()), and the compressed tree that it
 * leads to. Among all trees that arise by turning inner nodes into leaves, this one has the largest
 * J(T) = sum_t weight_t I_t(T) - alpha I_X(T), and is the smallest if several have it. (Larsson et
 * al., "Information-theoretic Abstraction of Semantic Octree Models for Integrated Perception and
 * Planning", problem (1), algorithm 1.)
 *
 * A view: it holds nothing but the map, which must outlive it. */
class Abstraction {
 public:
  /** \throw std::logic_error the map keeps no G-values. */
  explicit Abstraction(SemanticOcTree& map);

  /** Without names: see AbstractionOptions::forClasses(). */
  const AbstractionOptions& options() const;
  /** Depth of the cubes from which on nodes have their price: of the blocks where the nodes above
   * them are free, otherwise 0. */
  int rootDepth() const;
  /** Whether the compressed tree expands a node, if it does those above. */
  bool isExpanded(const SemanticOcTreeNode& node) const;

  /** Leaves of the compressed tree in OctoMap's order (depth first). Visits inner nodes that the
   * tree expands, and its leaves. A leaf of the map above the blocks is told block by block, so the
   * map's pruning leaves no trace. Whatever counts leaves counts one. */
  std::vector<LeafCell> leaves() const;
  /** The leaves() that have voxels in a box, in the same order; visits nothing outside.
   * \param low, high keys of the box's lowest and highest voxels
   * \param onlyOccupied leaves out, and does not visit, what is likelier free */
  std::vector<LeafCell> leavesIn(const octomap::OcTreeKey& low, const octomap::OcTreeKey& high,
                                 bool onlyOccupied) const;
  /** J of the compressed tree, see AbstractionMeasures. */
  double objective() const;
  /** Computes all inner nodes anew. */
  AbstractionMeasures measures() const;

  /** The compressed tree as a map of its own. A leaf is as occupied as its most occupied voxel
   * (safe for collision checks); its p(class | occupied) is that of the voxels in which labels
   * were seen,
   *
   *     p(class k | occupied) = sum_v p_k(v) / sum_j sum_v p_j(v),
   *
   * truncated as everywhere. (The G-values have the mixture of all known voxels.) What it states of
   * them has a power of its own where the map is calibrated: mixtures state too little. */
  SemanticOcTree compressedMap() const;
  /** \param compressed to be filled, see MapOperations.h; like an emptyCompressedMap()
   * \throw std::invalid_argument it is not empty, or of another kind. */
  void compressTo(SemanticOcTree& compressed) const;
  /** An empty map of the same resolution, classes and filter parameters, not calibrated. */
  SemanticOcTree emptyCompressedMap() const;

  /** New alpha: computes all inner nodes anew. \throw std::invalid_argument */
  void setAlpha(double alpha);
  /** New weights, in the order of the options' terms: the same. \throw std::invalid_argument */
  void setWeights(const std::vector<double>& termWeights, double alpha);
  /** New regions: recomputes the cells whose density changes and what is above them. */
  void setRegions(const std::vector<Region>& regions);

  /** An inner node below the roots, and the alpha from which on it is not expanded: AlphaTrees. */
  struct NodeTau : Cube {
    bool isExpanded;    ///< in the compressed tree
    AddedToTree added;  ///< by expanding it
    double tau;         ///< see tree_abstraction::collapseAlphas()
  };
  /** Calls visit(node) for all nodes but the free ones above the blocks, depth first. Some 262,144
   * of them are in memory, or those below one root if these are more.
   * \return what the free nodes above the blocks add to a single leaf */
  AddedToTree forEachTau(const std::function<void(const NodeTau&)>& visit) const;

  /** An inner node as the compressed trees of all weights and alphas see it. */
  struct PathNode : Cube {
    bool isFree;      ///< above the blocks: expanded by every tree
    bool isExpanded;  ///< in the compressed tree
    double share;     ///< p(n)
    double price;     ///< what expanding it costs, p(n) H(Pi): nats for each unit of alpha
    int addedLeaves;  ///< known children - 1
  };
  using VisitPathNode = std::function<void(const PathNode&, const std::vector<double>&)>;
  /** Calls visit(node, information) for all inner nodes, a node's subtree right behind it in the
   * order of its children: nodes that are not free are those of forEachTau(). `information` is what
   * expanding the node adds to each term, nats, in the order of the options' terms. */
  void forEachPathNode(const VisitPathNode& visit) const;

 private:
  friend class LeafFollower;

  CompressedTree compressedTree() const;
  /** Up to date. If that fails, readers are told everything next. */
  std::shared_ptr<LeafLog> leafLog() const;

  SemanticOcTree& m_map;
  GTree& m_gTree;
};

/** A reader of the leaves of a map's compressed tree, as MapFollower is one of its tiles, with the
 * same rules. A new abstraction is told as everything.
 * \throw std::logic_error in all functions: the map is gone, broken, or keeps no G-values. */
class LeafFollower {
 public:
  /** \param map need not keep G-values yet */
  explicit LeafFollower(SemanticOcTree& map);
  ~LeafFollower();
  LeafFollower(LeafFollower&&) noexcept;
  LeafFollower& operator=(LeafFollower&&) noexcept;

  /** Leaves that came and went since the last call, in time proportional to the nodes that
   * changed. */
  TreeChange leaves();
  /** Skips what leaves() would tell, which may be all of a map. \return number of leaves now */
  std::size_t skipLeaves();

 private:
  struct Content;
  std::unique_ptr<Content> m;
};

/** A map of the nodes down to those that are not expanded: see Abstraction::compressedMap().
 * \param isExpanded called for inner nodes of the map below none that is not: a node's subtree
 * right behind it, in the order of its children */
SemanticOcTree compressedMap(const SemanticOcTree& map,
                             const std::function<bool(const SemanticOcTreeNode&)>& isExpanded);

}  // namespace semantic_octree
