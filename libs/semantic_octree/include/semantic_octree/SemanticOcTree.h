#pragma once
#include <octomap/octomap_types.h>
#include <semantic_octree/ClassFilter.h>
#include <semantic_octree/InsertionOptions.h>
#include <semantic_octree/Keys.h>
#include <semantic_octree/SemanticOcTreeNode.h>
#include <semantic_octree/TreeIterator.h>
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace semantic_octree {

using semantic_types::ClassTable;
using semantic_types::LabeledCloud;

class FusionRule;
class MapFollower;
class NodeObserver;
class NodeStore;
class Scan;
class ChangeLog;

/** What the map knows about a place. */
struct CellState {
  enum class Status { Unknown, Free, Occupied };
  Status status = Status::Unknown;
  /** p(occupied); 0.5 where unknown. Occupied means above 0.5. */
  double occupancy = 0.5;
  /** Class with the largest probability, lowest id on a tie; kNoClass (which ClassTable::name()
   * calls "no class") in free and unknown space and where no return had a label. */
  ClassId likeliestClass = kNoClass;
  /** p(likeliestClass), among free space and all classes. */
  double probability = 0;
};

/** First occupied voxel along a ray. */
struct RayHit {
  octomap::OcTreeKey key;
  octomap::point3d center;  ///< of the voxel, meters, map frame
  CellState state;
};

/** Semantic octree: a tree of 16 levels as OctoMap's, whose leaves hold a Bayesian distribution
 * over free space and K classes (see ClassFilter).
 *
 * Reading is OctoMap's: keys, iterators, search, ray casts have its names and its meaning. Space
 * without a node is unknown. The tree changes through the functions below only. Not thread safe,
 * except for reading from several threads.
 *
 * Functions that fail leave the map as it was. Only insert() and age() may lose it: if memory runs
 * out halfway, a broken map is left, whose functions throw std::logic_error until clear().
 * MapFolder keeps parts of a map on disk. */
class SemanticOcTree {
 public:
  using Node = SemanticOcTreeNode;
  using Belief = ClassBelief;
  using leaf_iterator = TreeIterator;
  using tree_iterator = TreeIterator;
  using leaf_bbx_iterator = TreeIterator;

  /** \param voxelSize edge of a voxel (the resolution), meters
   * \throw std::invalid_argument voxel size not positive, no classes, or bad filter parameters. */
  SemanticOcTree(double voxelSize, ClassTable classes, const FilterParameters& filter = {});
  ~SemanticOcTree();
  SemanticOcTree(const SemanticOcTree& o);
  /** Leaves an empty map of the same kind behind. */
  SemanticOcTree(SemanticOcTree&& o);
  SemanticOcTree& operator=(SemanticOcTree o);
  void swap(SemanticOcTree& o);

  // --- Reading, as in OctoMap ---
  double getResolution() const { return m_resolution; }
  unsigned getTreeDepth() const { return kTreeDepth; }
  /** Edge of the cube that a node at a depth stands for, meters. */
  double getNodeSize(unsigned depth) const {
    return m_resolution * edgeAtDepth(static_cast<int>(depth));
  }
  std::string getTreeType() const { return "SemanticOcTree"; }
  /** Number of nodes, inner nodes and leaves. */
  std::size_t size() const;
  /** Number of leaves; takes no time, unlike OctoMap's. */
  std::size_t getNumLeafNodes() const;
  bool empty() const { return !root(); }
  /** Bytes of nodes, class records and bookkeeping; the same for equal maps, however they came to
   * be. Memory set aside for more is not counted. */
  std::size_t memoryUsage() const;
  /** Lowest and highest corner of all known cells, meters, map frame; 0 in an empty map. */
  void getMetricMin(double& x, double& y, double& z) const;
  void getMetricMax(double& x, double& y, double& z) const;

  Node root() const;
  /** The leaf that holds a voxel, or its ancestor at a depth (0: the finest); none where that is
   * unknown. */
  Node search(const octomap::OcTreeKey& key, unsigned depth = 0) const;
  bool nodeHasChildren(const Node& node) const { return !node.isLeaf(); }
  bool nodeChildExists(const Node& node, unsigned i) const {
    return static_cast<bool>(node.child(static_cast<int>(i)));
  }
  Node getNodeChild(const Node& node, unsigned i) const { return node.child(static_cast<int>(i)); }
  /** Likelier occupied than free. */
  bool isNodeOccupied(const Node& node) const { return node.getLogOdds() > 0; }

  /** Leaves down to a depth (0: all); at that depth also inner nodes. */
  leaf_iterator begin_leafs(unsigned maxDepth = 0) const;
  leaf_iterator end_leafs() const { return {}; }
  /** All nodes, parents first. */
  tree_iterator begin_tree(unsigned maxDepth = 0) const;
  tree_iterator end_tree() const { return {}; }
  /** Leaves with voxels in a box, both corners included. */
  leaf_bbx_iterator begin_leafs_bbx(const octomap::OcTreeKey& low, const octomap::OcTreeKey& high,
                                    unsigned maxDepth = 0) const;
  /** Corners in meters, map frame; none if one of them is outside of the map. */
  leaf_bbx_iterator begin_leafs_bbx(const octomap::point3d& low, const octomap::point3d& high,
                                    unsigned maxDepth = 0) const;
  leaf_bbx_iterator end_leafs_bbx() const { return {}; }

  /** Key of the voxel that holds a point (meters, map frame), which must be inside of the map. */
  octomap::OcTreeKey coordToKey(const octomap::point3d& point) const;
  octomap::OcTreeKey coordToKey(double x, double y, double z) const;
  /** \return whether the point is inside of the map */
  bool coordToKeyChecked(const octomap::point3d& point, octomap::OcTreeKey& key) const;
  bool coordToKeyChecked(double x, double y, double z, octomap::OcTreeKey& key) const;
  /** Center of a voxel, or of the cube at a depth that it is in; meters, map frame. */
  octomap::point3d keyToCoord(const octomap::OcTreeKey& key, unsigned depth = kTreeDepth) const;
  /** Voxels that the line from one point to another (meters, map frame) crosses, without the last
   * one. \return false: one of the points is outside of the map */
  bool computeRayKeys(const octomap::point3d& origin, const octomap::point3d& end,
                      octomap::KeyRay& ray) const;

  const ClassTable& classes() const { return m_classes; }
  int numClasses() const { return m_classes.size(); }
  const FilterParameters& filterParameters() const { return m_parameters; }

  // --- Classes ---
  /** State of the cell that contains a point (meters, map frame), or of its ancestor at a depth
   * (0: the finest). An inner node's occupancy is its most occupied leaf's, p(class | occupied)
   * that of the mixture of its leaves in which labels were seen. */
  CellState query(double x, double y, double z, unsigned depth = 0) const;
  CellState query(const octomap::OcTreeKey& key, unsigned depth = 0) const;
  CellState query(const Node& node) const;
  /** The class record of a leaf, which the filter made of scans; for a leaf without one, classes
   * that are equally likely. */
  Belief belief(const Node& leaf) const;
  /** What is stated of a leaf's classes (see Calibration), here and in query() and distribution().
   */
  Belief statedBelief(const Node& leaf) const { return m_filter.stated(belief(leaf)); }
  /** K + 1 probabilities, [0] = free space: a leaf's distribution, or the mixture of the known
   * leaves below an inner node weighted by volume. */
  std::vector<double> distribution(const Node& node) const;
  /** First occupied voxel along a ray. \param direction any length \param maxRange meters from the
   * origin to the voxel's center, 0: none
   * \return nothing if there is none, or if unknown space comes first and is not ignored
   * \throw std::invalid_argument the direction is zero or not finite. */
  std::optional<RayHit> castRay(const octomap::point3d& origin, const octomap::point3d& direction,
                                double maxRange = 0, bool ignoreUnknown = true) const;

  /** Whether both are one map to the last bit: resolution, classes, parameters, nodes, class
   * records and, where both keep it, the abstraction's bookkeeping. */
  bool operator==(const SemanticOcTree& o) const;
  bool operator!=(const SemanticOcTree& o) const { return !(*this == o); }

  /** Whether the map is in a folder of tiles that was opened to be read (MapFolder): it will not
   * change. */
  bool isReadOnly() const;

  // --- Changing ---
  /** Inserts a scan: each voxel is updated at most once. Voxels in which returns end are hit (see
   * ClassFilter::hit() for their labels), voxels that beams cross are free unless hit.
   * \param cloud points in the sensor's frame
   * \param secondsSince by which the map ages first, see age()
   * \throw std::out_of_range the sensor is outside the map \throw std::invalid_argument its pose is
   * not finite, vectors are of different lengths, or a class is not in the table
   * \throw std::bad_alloc no memory; look at isBroken(). */
  InsertionReport insert(const LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
                         const InsertionOptions& options = {}, double secondsSince = 0);
  /** Time passes, and what has a half-life (see ClassTable) is forgotten. A voxel's log-odds of
   * occupancy, and the differences between its classes', halve within the half-life of its
   * likeliest class, in eight steps. With less than 0.1 left of its occupancy, it is unknown
   * (doc/how-it-works/decay.md). Many short times do what a long one does, to the last bit. Without
   * half-lives it does nothing.
   * \throw std::invalid_argument not 0 to 1e9 seconds \throw std::out_of_range more than 200 years
   * in all \throw std::bad_alloc no memory; look at isBroken(). */
  void age(double seconds);
  /** Seconds by which the map has aged; files keep them. */
  double clock() const { return static_cast<double>(m_clock) * 1e-9; }
  /** Classes take the half-lives that a table has for their names; free space, too. Classes that
   * the table does not have keep theirs. */
  void setHalfLives(const ClassTable& table);
  /** Beliefs stay as they are. \throw std::invalid_argument naming the value. */
  void setCalibration(const Calibration& calibration);
  /** For soft labels to come: FilterParameters::classPrior.
   * \throw std::invalid_argument naming the value. */
  void setClassPrior(std::vector<float> prior);
  /** Memory ran out, or a tile's file failed (MapFolder), while the map changed. */
  bool isBroken() const { return m_store == nullptr; }
  /** Removes all nodes; the clock begins anew.
   * \throw std::logic_error (whatever changes the map) isReadOnly() */
  void clear();
  /** A new reader of what changes: which tiles. (Of leaves of the compressed tree: LeafFollower.)
   */
  MapFollower follow();
  /** Whether children that agree are merged (default). Only an empty tree can be changed.
   * \throw std::logic_error the tree is not empty. */
  void setPruning(bool on);
  bool pruning() const { return m_pruning; }

 private:
  friend class MapAccess;
  /** \throw std::logic_error the map is broken. */
  NodeStore& store() const;
  void setFilter(FilterParameters parameters);

  double m_resolution;
  ClassTable m_classes;
  FilterParameters m_parameters;
  ClassFilter m_filter;
  std::shared_ptr<const FusionRule> m_rule;  ///< null: the filter
  bool m_pruning = true;
  std::int64_t m_clock = 0;                  ///< ns; stands still while nothing has a half-life
  std::unique_ptr<NodeStore> m_store;        ///< null: the map is broken
  std::unique_ptr<NodeObserver> m_observer;  ///< null: nothing is kept of inner nodes
  std::unique_ptr<Scan> m_scan;              ///< buffers of the last insertion, if there was one
  std::shared_ptr<SemanticOcTree*> m_self;   ///< readers see that it is gone; null: there was none
  std::weak_ptr<ChangeLog> m_tileLog;        ///< readers own what they read
};

/** A map stays as it is while this lives: whoever would change it in another thread gets
 * std::logic_error instead. SemanticPlanner holds one whenever it looks. The lock waits for nobody.
 * Who inserts and reads in two threads takes turns by an own mutex, or has a
 * semantic_navigation::Navigator do it. */
class ReadLock {
 public:
  /** \param map must outlive this \throw std::logic_error another thread changes it now. */
  explicit ReadLock(const SemanticOcTree& map);
  ~ReadLock();
  ReadLock(const ReadLock&) = delete;
  ReadLock& operator=(const ReadLock&) = delete;

 private:
  const NodeStore& m_store;
};

/** An empty map of the same kind and time: resolution, classes, filter parameters, pruning, clock.
 */
SemanticOcTree emptyLike(const SemanticOcTree& map);

}  // namespace semantic_octree
