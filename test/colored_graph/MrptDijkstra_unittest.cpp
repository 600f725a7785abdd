#include <colored_graph/ColoredAStar.h>
#include <gtest/gtest.h>
#include <mrpt/graphs/CDirectedGraph.h>
#include <mrpt/graphs/dijkstra.h>

#include <algorithm>
#include <map>
#include <utility>

#include "PlaneGraph.h"

using namespace colored_graph;

namespace {

struct LengthEdge {
  double length = 0;
};
using MrptGraph = mrpt::graphs::CDirectedGraph<LengthEdge>;

/** Of parallel edges the shortest: CDijkstra looks at one only. */
MrptGraph shortestEdges(const ColoredGraph& graph) {
  std::map<std::pair<VertexId, VertexId>, double> lengths;
  for (EdgeId e = 0; e < graph.edgeIdEnd(); ++e) {
    const Edge& edge = graph.edge(e);
    if (edge.state != EdgeState::Usable) continue;
    const double length = static_cast<double>(edge.length);
    const auto known = lengths.emplace(std::minmax(edge.a, edge.b), length).first;
    known->second = std::min(known->second, length);
  }
  MrptGraph mrptGraph;
  for (const auto& [ends, length] : lengths)
    mrptGraph.insertEdge(ends.first, ends.second, LengthEdge{length});
  return mrptGraph;
}

}  // namespace

TEST(MrptDijkstra, agreesOnLengthsWhereThereIsOneRank) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    PlaneGraph plane = randomPlaneGraph(seed, 12, 90, 6);
    const CostModel model{ClassOrder(PlaneGraph::kClasses, {{0, 1, 2, 3, 4}})};
    const MrptGraph mrptGraph = shortestEdges(plane.graph);
    const auto length = [](const MrptGraph&, mrpt::graphs::TNodeID, mrpt::graphs::TNodeID,
                           const MrptGraph::edge_t& edge) { return edge.length; };
    const mrpt::graphs::CDijkstra<MrptGraph> tree(mrptGraph, 0, length);
    for (VertexId goal = 1; goal < 12; ++goal) {
      const PathResult result = findColoredPath(plane.graph, 0, goal, model);
      ASSERT_TRUE(result.found()) << "seed " << seed;
      EXPECT_EQ(result.cost.back(), tree.getNodeDistanceToRoot(goal)) << "seed " << seed;
    }
  }
}
