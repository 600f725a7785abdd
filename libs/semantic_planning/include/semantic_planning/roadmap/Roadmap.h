#pragma once
#include <colored_graph/ColoredGraph.h>
#include <semantic_planning/roadmap/CollisionChecker.h>
#include <semantic_planning/roadmap/PosePair.h>
#include <semantic_planning/roadmap/RoadmapOptions.h>

#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace semantic_planning {

class NearestPoses;

/** Poses on the ground as vertices of a colored graph, and Reeds-Shepp curves as its edges, whose
 * tolls are what driving them costs beyond their length (MotionCost). A vehicle that only drives
 * forward has an edge for each way.
 *
 * An edge connects a with b if b is among the k nearest of a, or a among those of b, after every
 * insertion and removal. Query vertices (start and goal) have edges to twice as many, but are
 * nobody's neighbors.
 *
 * With RoadmapOptions::maxEdges the best of these edges stay: every vertex's nearest first, then
 * every vertex's second nearest, and so on; of those the shortest. They, too, are chosen anew after
 * every insertion and removal. Query vertices' edges do not count. */
class Roadmap {
 public:
  using VertexId = colored_graph::VertexId;
  using EdgeId = colored_graph::EdgeId;

  /** \param checker must outlive the roadmap. */
  Roadmap(const CollisionChecker& checker, const RoadmapOptions& options);
  ~Roadmap();

  /** Removes vertices, then inserts others; those that are near them get other neighbors.
   * \param classes of the new vertices, one for each pose. \return their ids */
  std::vector<VertexId> replace(const std::vector<VertexId>& removed,
                                const std::vector<GroundPose>& poses,
                                const std::vector<ClassId>& classes);

  VertexId addQueryVertex(const GroundPose& pose);
  void removeQueryVertex(VertexId v);

  /** Looks again at the edges that were evaluated over ground in these tiles. */
  void refresh(const std::vector<Column>& changedTiles);

  const colored_graph::ColoredGraph& graph() const { return m_graph; }
  /** For searches. */
  colored_graph::ColoredGraph& graph() { return m_graph; }
  const GroundPose& pose(VertexId v) const { return m_poses.at(v); }
  /** What the edge connects. */
  PosePair ends(EdgeId e) const;
  /** The edge's curve, from one of its ends to the other. */
  ReedsSheppCurve curve(EdgeId e, VertexId from) const;
  /** As colored_graph::SearchOptions::evaluate. */
  std::optional<colored_graph::EdgeProfile> evaluate(EdgeId e) const;
  /** As colored_graph::SearchOptions::lengthBound. */
  colored_graph::Length lengthBound(VertexId a, VertexId b) const;

 private:
  void link(VertexId a, VertexId b);
  void linkOneWay(VertexId from, VertexId to);
  void connect(VertexId a, VertexId b);
  std::set<std::pair<VertexId, VertexId>> neighbors() const;
  void reconcile();
  void reconcileQueryVertex(VertexId query);
  bool mayDependOn(const std::set<Column>& tiles, EdgeId e) const;
  void reevaluate(EdgeId e);
  void keepPose(VertexId v, const GroundPose& pose);

  const CollisionChecker& m_checker;
  colored_graph::ColoredGraph m_graph;
  std::unique_ptr<NearestPoses> m_nearest;
  std::size_t m_queryNeighbors, m_mostEdges;
  std::vector<GroundPose> m_poses;  ///< by vertex id
  std::set<VertexId> m_queryVertices;
};

}  // namespace semantic_planning
