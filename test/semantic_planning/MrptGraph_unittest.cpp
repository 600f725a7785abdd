#include <mrpt/graphs/dijkstra.h>
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

/** The node at a pose. */
mrpt::graphs::TNodeID nodeAt(const ClassNetwork& network, const mrpt::math::TPose2D& pose) {
  for (const auto& [id, node] : network.nodes)
    if (node.distanceTo(mrpt::poses::CPose2D(pose)) < 1e-9 && node.phi() == pose.phi) return id;
  throw std::logic_error("no node there");
}

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

TEST_F(PlannerTest, edgesOfANetworkAreThePosesOfTheirEndsSeenFromTheirStarts) {
  paintCorner();
  SemanticPlanner p = planner();
  p.plan(start, goal);
  const ClassNetwork network = toNetwork(p.roadmap(), kNames);
  for (const auto& [ids, pose] : network.edges) {
    const auto end = network.nodes.at(ids.first) + pose;
    EXPECT_NEAR(end.x(), network.nodes.at(ids.second).x(), 1e-9);
    EXPECT_NEAR(end.y(), network.nodes.at(ids.second).y(), 1e-9);
  }
}

TEST_F(PlannerTest, dijkstraOfMrptFindsTheSameFewestEdgesOfEachClassInTheNetwork) {
  paintCorner();
  options.roadmap.vertices = 150;
  options.edges = colored_graph::EdgeModel::Endpoint;
  options.cost = colored_graph::CostKind::Count;
  SemanticPlanner p = planner();
  const PlanResult plan = p.plan(start, goal);
  ASSERT_TRUE(plan.found());
  const Roadmap& roadmap = p.roadmap();
  const ClassNetwork network = toNetwork(roadmap, kNames);
  std::map<std::pair<unsigned, unsigned>, EdgeId> edges;
  for (EdgeId e = 0; e < roadmap.graph().edgeIdEnd(); ++e)
    if (roadmap.graph().containsEdge(e))
      edges[std::minmax({roadmap.graph().edge(e).a, roadmap.graph().edge(e).b})] = e;

  constexpr double kOfAWorseRank = 1000, kBlocked = 1e15;
  const std::map<std::string, int> ranks = {{"road", 0}, {"grass", 1}, {"mud", 2}, {"unknown", 3}};
  const auto weight = [&](const ClassNetwork& n, auto from, auto to, const auto&) {
    if (!roadmap.evaluate(edges.at(std::minmax<unsigned>(from, to)))) return kBlocked;
    const int rank = std::max(ranks.at(n.nodes.at(from).name), ranks.at(n.nodes.at(to).name));
    return rank == 0 ? 0 : std::pow(kOfAWorseRank, rank);
  };
  const mrpt::graphs::CDijkstra<ClassNetwork> dijkstra(network, nodeAt(network, start), weight);
  double expected = 0;
  for (std::size_t rank = 1; rank < 4; ++rank)
    expected += static_cast<double>(plan.cost.at(3 - rank)) * std::pow(kOfAWorseRank, rank);
  EXPECT_EQ(dijkstra.getNodeDistanceToRoot(nodeAt(network, goal)).value(), expected);
  EXPECT_GT(plan.cost.at(2), 0);
}
