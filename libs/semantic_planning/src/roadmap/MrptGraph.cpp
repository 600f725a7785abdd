#include <semantic_planning/roadmap/MrptGraph.h>

namespace semantic_planning {

using colored_graph::EdgeId;
using colored_graph::EdgeState;
using colored_graph::VertexId;
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

}  // namespace semantic_planning
