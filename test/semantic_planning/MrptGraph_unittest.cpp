#include <semantic_planning/roadmap/MrptGraph.h>

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

}  // namespace

TEST_F(PlannerTest, aRoadmapGoesThroughAGraphFileOfMrptAndBack) {
  paintCorner();
  options.roadmap.vertices = 100;
  SemanticPlanner p = planner();
  p.plan(start, goal);
  const TemporaryFolder folder;
  const std::string file = (folder / "roadmap.graph").string();
  toNetwork(p.roadmap()).saveToTextFile(file);

  CNetworkOfPoses2D network;
  network.loadFromTextFile(file);
  const EdgeChecker checker(p.ground(), options.vehicle, order, {});
  const ImportedGraph imported = fromNetwork(network, checker);
  EXPECT_EQ(imported.graph.vertexCount(), p.roadmap().graph().vertexCount());
  EXPECT_EQ(edgesOf(imported.graph), edgesOf(p.roadmap().graph()));
  for (colored_graph::VertexId v = 0; v < imported.poses.size(); ++v) {
    EXPECT_NEAR(imported.poses[v].pose.x, p.roadmap().pose(v).pose.x, 1e-3);
    EXPECT_NEAR(imported.poses[v].pose.y, p.roadmap().pose(v).pose.y, 1e-3);
    EXPECT_EQ(imported.poses[v].z, p.roadmap().pose(v).z);
  }
}

TEST_F(PlannerTest, edgesOfANetworkAreThePosesOfTheirEndsSeenFromTheirStarts) {
  paintCorner();
  SemanticPlanner p = planner();
  p.plan(start, goal);
  const CNetworkOfPoses2D network = toNetwork(p.roadmap());
  for (const auto& [ids, pose] : network.edges) {
    const auto end = network.nodes.at(ids.first) + pose;
    EXPECT_NEAR(end.x(), network.nodes.at(ids.second).x(), 1e-9);
    EXPECT_NEAR(end.y(), network.nodes.at(ids.second).y(), 1e-9);
  }
}

TEST_F(PlannerTest, aNetworkThatDoesNotFitTheGroundIsRefused) {
  paintCorner();
  SemanticPlanner p = planner();
  const EdgeChecker checker(p.ground(), options.vehicle, order, {});
  CNetworkOfPoses2D network;
  network.nodes[3] = mrpt::poses::CPose2D(500, 0, 0);
  EXPECT_TRUE(contains(errorOf([&] { fromNetwork(network, checker); }), "node 3"));
  network.nodes[3] = mrpt::poses::CPose2D(0, 0, 0);
  network.insertEdge(3, 8, mrpt::poses::CPose2D());
  EXPECT_TRUE(contains(errorOf([&] { fromNetwork(network, checker); }), "node 8"));
}
