#pragma once
#include <mrpt/graphs/CNetworkOfPoses.h>
#include <semantic_planning/roadmap/Roadmap.h>

namespace semantic_planning {

/** A roadmap as MRPT knows graphs: nodes with their global poses, and for each usable or
 * unevaluated edge the pose of its end as seen from its start. Classes do not fit in.
 * Its saveToTextFile() writes a .graph file. */
mrpt::graphs::CNetworkOfPoses2D toNetwork(const Roadmap& roadmap);

/** The graph of a network, such as loadFromTextFile() reads, with vertices on the ground.
 * Edges are unevaluated, their lower bound is the vehicle's shortest curve. */
struct ImportedGraph {
  colored_graph::ColoredGraph graph;
  std::vector<GroundPose> poses;  ///< by vertex id
};
/** \throw std::invalid_argument naming the node: an edge to a node without a pose, or a node that
 * is not on drivable ground. */
ImportedGraph fromNetwork(const mrpt::graphs::CNetworkOfPoses2D& network,
                          const EdgeChecker& checker);

}  // namespace semantic_planning
