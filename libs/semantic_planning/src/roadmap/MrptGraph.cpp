#include <semantic_planning/roadmap/MrptGraph.h>

#include <map>
#include <stdexcept>
#include <string>

namespace semantic_planning {

using colored_graph::EdgeId;
using colored_graph::EdgeState;
using colored_graph::VertexId;
using mrpt::graphs::CNetworkOfPoses2D;
using mrpt::poses::CPose2D;

ClassNetwork toNetwork(const Roadmap& roadmap, const std::vector<std::string>& classNames) {
  const colored_graph::ColoredGraph& graph = roadmap.graph();
  ClassNetwork network;
  for (VertexId v = 0; v < graph.vertexIdEnd(); ++v) {
    if (!graph.containsVertex(v)) continue;
    auto& node = network.nodes[v];
    static_cast<CPose2D&>(node) = CPose2D(roadmap.pose(v).pose);
    node.name = classNames.at(graph.vertexClass(v));
  }
  for (EdgeId e = 0; e < graph.edgeIdEnd(); ++e) {
    if (!graph.containsEdge(e) || graph.edge(e).state == EdgeState::Blocked) continue;
    const VertexId a = graph.edge(e).a, b = graph.edge(e).b;
    network.insertEdge(a, b, CPose2D(roadmap.pose(b).pose) - CPose2D(roadmap.pose(a).pose));
  }
  if (!network.nodes.empty()) network.root = network.nodes.begin()->first;
  return network;
}

ImportedGraph fromNetwork(const CNetworkOfPoses2D& network, const EdgeChecker& checker) {
  ImportedGraph imported{colored_graph::ColoredGraph(checker.order().classes()), {}};
  std::map<mrpt::graphs::TNodeID, VertexId> vertexOf;
  for (const auto& [node, pose] : network.nodes) {
    const auto onGround = checker.place(pose.asTPose());
    if (!onGround)
      throw std::invalid_argument("node " + std::to_string(node) + " is not on drivable ground");
    vertexOf[node] = imported.graph.addVertex(checker.classAt(*onGround));
    imported.poses.push_back(*onGround);
  }
  const auto vertex = [&](mrpt::graphs::TNodeID node) {
    const auto found = vertexOf.find(node);
    if (found == vertexOf.end())
      throw std::invalid_argument("node " + std::to_string(node) + " has an edge and no pose");
    return found->second;
  };
  for (const auto& [nodes, unused] : network.edges) {
    const VertexId a = vertex(nodes.first), b = vertex(nodes.second);
    const double length =
        checker.reedsShepp().distance(imported.poses[a].pose, imported.poses[b].pose);
    imported.graph.addUnevaluatedEdge(a, b, colored_graph::lengthDown(length));
  }
  return imported;
}

}  // namespace semantic_planning
