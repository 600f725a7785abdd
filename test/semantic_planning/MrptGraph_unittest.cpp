#include <semantic_planning/roadmap/MrptGraph.h>

#include <algorithm>
#include <map>

#include "PlannerFixture.h"
#include "TemporaryFolder.h"

using namespace semantic_planning;
using colored_graph::EdgeId;
using mrpt::graphs::CNetworkOfPoses2D;

namespace {

std::set<std::pair<unsigned, unsigned>> edgesOf(const colored_graph::ColoredGraph& graph) {
  std::set<std::pair<unsigned, unsigned>> edges;
  for (EdgeId e = 0; e < graph.edgeIdEnd(); ++e)
    if (graph.containsEdge(e) && graph.edge(e).state != colored_graph::EdgeState::Blocked)
      edges.insert(std::minmax({graph.edge(e).a, graph.edge(e).b}));
  return edges;
}

const std::vector<std::string> kNames = {"unknown", "road", "grass", "wall", "mud"};

}  // namespace

TEST_F(PlannerTest, mrptReadsARoadmapFromAGraphFile) {
  paintCorner();
  options.roadmap.vertices = 100;
  SemanticPlanner p = planner();
  p.plan(start, goal);
  const TemporaryFolder folder;
  const std::string file = (folder / "roadmap.graph").string();
  toNetwork(p.roadmap(), kNames).saveToTextFile(file);

  CNetworkOfPoses2D network;
  network.loadFromTextFile(file);
  EXPECT_EQ(network.nodes.size(), p.roadmap().graph().vertexCount());
  std::set<std::pair<unsigned, unsigned>> edges;
  for (const auto& [nodes, pose] : network.edges)
    edges.insert(std::minmax<unsigned>(nodes.first, nodes.second));
  EXPECT_EQ(edges, edgesOf(p.roadmap().graph()));
  for (const auto& [node, pose] : network.nodes) {
    const auto& expected = p.roadmap().pose(static_cast<unsigned>(node)).pose;
    EXPECT_NEAR(pose.x(), expected.x, 1e-3);
    EXPECT_NEAR(pose.y(), expected.y, 1e-3);
  }
}

TEST_F(PlannerTest, aNetworkHasTheClassesOfItsNodesAndEdgesArePosesOfEndsSeenFromTheirStarts) {
  paintCorner();
  SemanticPlanner p = planner();
  p.plan(start, goal);
  const ClassNetwork network = toNetwork(p.roadmap(), kNames);
  std::map<std::string, int> named;
  for (const auto& [id, node] : network.nodes) {
    const auto vertex = static_cast<colored_graph::VertexId>(id);
    EXPECT_EQ(node.name, kNames[p.roadmap().graph().vertexClass(vertex)]);
    ++named[node.name];
  }
  EXPECT_GT(named["road"], 20);
  EXPECT_GT(named["grass"], 20);
  for (const auto& [ids, pose] : network.edges) {
    const auto end = network.nodes.at(ids.first) + pose;
    EXPECT_NEAR(end.x(), network.nodes.at(ids.second).x(), 1e-9);
    EXPECT_NEAR(end.y(), network.nodes.at(ids.second).y(), 1e-9);
  }
}
