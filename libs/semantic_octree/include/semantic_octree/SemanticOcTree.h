#pragma once
#include <octomap/OccupancyOcTreeBase.h>
#include <semantic_octree/AbstractionOptions.h>
#include <semantic_octree/ClassFilter.h>
#include <semantic_octree/InsertionOptions.h>
#include <semantic_octree/SemanticOcTreeNode.h>
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace semantic_octree {

using semantic_types::ClassTable;
using semantic_types::LabeledCloud;

class GTree;
class LeafChanges;
class NodeStore;
class Scan;
class TouchedTiles;

/** What the map knows about a place. */
struct CellState {
  enum class Status { Unknown, Free, Occupied };
  Status status = Status::Unknown;
  /** p(occupied); 0.5 where unknown. Occupied means above 0.5. */
  double occupancy = 0.5;
  /** Class with the largest probability, lowest id on a tie; kNoClass (which ClassTable::name()
   * calls "no class") in free and unknown space and where no return had a label. */
  ClassId likeliestClass = kNoClass;
  /** Its probability p(class), among free space and all classes. */
  double probability = 0;
};

/** First occupied voxel along a ray. */
struct RayHit {
  octomap::OcTreeKey key;
  octomap::point3d center;  ///< of the voxel, meters, map frame
  CellState state;
};

/** Semantic octree: OctoMap's tree of 16 levels whose leaves hold a Bayesian distribution over free
 * space and K classes (see ClassFilter).
 *
 * Reading is OctoMap's: keys, iterators, search, ray casts. Space without a node is unknown. The
 * tree changes through the functions below only; OctoMap's own insertion and editing are not
 * available. Not thread safe, except for reading from several threads. */
class SemanticOcTree : protected octomap::OccupancyOcTreeBase<SemanticOcTreeNode> {
 public:
  using Base = octomap::OccupancyOcTreeBase<SemanticOcTreeNode>;
  using Node = SemanticOcTreeNode;
  using Belief = ClassBelief<float>;

  /** \param voxelSize edge of a voxel (the resolution), meters
   * \throw std::invalid_argument voxel size not positive, no classes, or bad filter parameters. */
  SemanticOcTree(double voxelSize, ClassTable classes, const FilterParameters& filter = {});
  ~SemanticOcTree() override;
  SemanticOcTree(const SemanticOcTree& o);
  /** Leaves an empty map of the same kind behind. */
  SemanticOcTree(SemanticOcTree&& o);
  SemanticOcTree& operator=(SemanticOcTree o);
  void swap(SemanticOcTree& o);

  // --- Reading, as in OctoMap ---
  using Base::begin_leafs;
  using Base::begin_leafs_bbx;
  using Base::begin_tree;
  using Base::castRay;
  using Base::computeRayKeys;
  using Base::coordToKey;
  using Base::coordToKeyChecked;
  using Base::end_leafs;
  using Base::end_leafs_bbx;
  using Base::end_tree;
  using Base::getMetricMax;
  using Base::getMetricMin;
  using Base::getNodeChild;
  using Base::getNodeSize;
  using Base::getResolution;
  using Base::getTreeDepth;
  using Base::isNodeOccupied;
  using Base::keyToCoord;
  using Base::leaf_bbx_iterator;
  using Base::leaf_iterator;
  using Base::nodeChildExists;
  using Base::nodeHasChildren;
  using Base::tree_iterator;
  const Node* root() const { return Base::root; }
  const Node* search(const octomap::OcTreeKey& key, unsigned depth = 0) const {
    return Base::search(key, depth);
  }
  std::string getTreeType() const override { return "SemanticOcTree"; }
  /** Number of nodes, inner nodes and leaves. */
  std::size_t size() const override { return tree_size; }
  /** Number of leaves; takes no time, unlike OctoMap's. */
  std::size_t getNumLeafNodes() const;
  bool empty() const { return Base::root == nullptr; }
  /** Bytes held by nodes, class records and bookkeeping. */
  std::size_t memoryUsage() const override;

  const ClassTable& classes() const { return m_classes; }
  int numClasses() const { return m_classes.size(); }
  const FilterParameters& filterParameters() const { return m_parameters; }

  // --- Classes ---
  /** State of the cell that contains a point (meters, map frame), or of its ancestor at a depth
   * (0: the finest). An inner node's occupancy is its most occupied leaf's, its classes those of
   * the mixture of its known leaves by volume. */
  CellState query(double x, double y, double z, unsigned depth = 0) const;
  CellState query(const octomap::OcTreeKey& key, unsigned depth = 0) const;
  CellState query(const Node& node) const;
  /** The class record of a leaf; for a leaf without one, classes that are equally likely. */
  Belief belief(const Node& leaf) const;
  /** K + 1 probabilities, [0] = free space: a leaf's distribution, or the mixture of the known
   * leaves below an inner node weighted by volume. */
  std::vector<double> distribution(const Node& node) const;
  /** First occupied voxel along a ray. \param direction any length \param maxRange meters from the
   * origin to the voxel's center, 0: none
   * \return nothing if there is none, or if unknown space comes first and is not ignored
   * \throw std::invalid_argument the direction is zero or not finite. */
  std::optional<RayHit> castRay(const octomap::point3d& origin, const octomap::point3d& direction,
                                double maxRange = 0, bool ignoreUnknown = true) const;

  /** The same map to the last bit: resolution, classes, parameters, nodes, class records and, where
   * both keep it, the abstraction's bookkeeping. */
  bool operator==(const SemanticOcTree& o) const;
  bool operator!=(const SemanticOcTree& o) const { return !(*this == o); }

  // --- Changing ---
  /** Inserts a scan: each voxel is updated at most once. Voxels in which returns end are hit (see
   * ClassFilter::hit() for their labels), voxels that beams cross are free unless hit.
   * \param cloud points in the sensor's frame
   * \throw std::out_of_range the sensor is outside the map
   * \throw std::invalid_argument vectors of different lengths, or a class that is not in the table.
   */
  InsertionReport insert(const LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
                         const InsertionOptions& options = {});
  /** Removes all nodes. Tiles that were touched before are not reported any more. */
  void clear() override;
  /** Lowest keys of the tiles of 8 x 8 x 8 voxels in which insert() changed something since the
   * last call, sorted; keys are multiples of 8. The first call reports all tiles of the map that
   * are known in part, and starts the record. */
  std::vector<octomap::OcTreeKey> takeTouchedTiles();
  /** Whether children that agree are merged (default). Only an empty tree can be changed.
   * \throw std::logic_error the tree is not empty. */
  void setPruning(bool on);
  bool pruning() const { return m_pruning; }

  /** Keeps the class mixtures and G-values of inner nodes from now on: insert() updates them in the
   * same pass. See Abstraction for what can be had from them.
   * \throw std::invalid_argument bad options. */
  void setAbstraction(const AbstractionOptions& options);
  /** Keeps them no longer. */
  void dropAbstraction();
  bool hasAbstraction() const { return m_gTree != nullptr; }

 protected:
  SemanticOcTree* create() const override {
    return new SemanticOcTree(resolution, m_classes, m_parameters);
  }

 private:
  friend class Abstraction;
  friend class TreeBuilder;
  friend class TreeReader;
  /** Moves all nodes to a store with room for (or without) bookkeeping. */
  void rebuildStore();
  /** After the store's nodes changed. */
  void attachRoot();

  ClassTable m_classes;
  FilterParameters m_parameters;
  ClassFilter<float> m_filter;
  bool m_pruning = true;
  std::unique_ptr<NodeStore> m_store;
  std::unique_ptr<GTree> m_gTree;  ///< null: no abstraction is kept
  std::unique_ptr<LeafChanges> m_leafChanges;
  std::unique_ptr<TouchedTiles> m_touched;  ///< null: nobody asks for them
  std::unique_ptr<Scan> m_scan;             ///< buffers of the last insertion
};

}  // namespace semantic_octree
