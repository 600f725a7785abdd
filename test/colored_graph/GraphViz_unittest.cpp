#include <colored_graph/GraphViz.h>
#include <gtest/gtest.h>

#include <ios>
#include <sstream>
#include <stdexcept>

using namespace colored_graph;

namespace {

ColoredGraph roadAndGrass() {
  ColoredGraph graph(2);
  graph.addVertex(0);
  graph.addVertex(1);
  graph.addVertex(0);
  graph.addVertex(0);
  graph.addEdge(0, 1, {{0, 10000}, {1, 25000}});
  graph.addUnevaluatedEdge(1, 2, 12345);
  graph.setBlocked(graph.addEdge(0, 2, {{0, 5000}}));
  graph.removeVertex(3);
  return graph;
}

std::string written(const ColoredGraph& graph, const PathResult& path = {},
                    const GraphVizOptions& options = {}) {
  std::ostringstream out;
  writeGraphViz(out, graph, path, options);
  return out.str();
}

}  // namespace

TEST(GraphViz, writesVerticesEdgesAndTheirStates) {
  EXPECT_EQ(written(roadAndGrass()),
            "graph colored {\n"
            "  0 [color=\"black\"];\n"
            "  1 [color=\"black\"];\n"
            "  2 [color=\"black\"];\n"
            "  0 -- 1 [label=\"3.5000\" color=\"black\"];\n"
            "  1 -- 2 [label=\"1.2345\" style=dashed];\n"
            "  0 -- 2 [label=\"0.5000\" style=dotted];\n"
            "}\n");
}

TEST(GraphViz, drawsColorsPositionsAndThePath) {
  const ColoredGraph graph = roadAndGrass();
  GraphVizOptions options;
  options.color = [](GraphClass id) { return id == 0 ? "gray\"50" : "green"; };
  options.position = [](VertexId v) { return std::make_pair(v * 10.0, -0.5); };
  PathResult path;
  path.edges = {0};
  const std::string text = written(graph, path, options);
  EXPECT_NE(text.find("  0 [color=\"gray\\\"50\" pos=\"0.00,-0.50\"];\n"), std::string::npos);
  EXPECT_NE(text.find("  1 [color=\"green\" pos=\"10.00,-0.50\"];\n"), std::string::npos);
  EXPECT_NE(text.find("  0 -- 1 [label=\"3.5000\" color=\"green\" penwidth=4];\n"),
            std::string::npos);
}

TEST(GraphViz, drawsAnArrowWhereAnEdgeLeadsOneWay) {
  ColoredGraph graph = roadAndGrass();
  graph.setTolls(0, {0, kClosed});
  graph.setTolls(1, {kClosed, 5});
  EXPECT_NE(written(graph).find("color=\"black\" dir=forward];"), std::string::npos);
  EXPECT_NE(written(graph).find("style=dashed dir=back];"), std::string::npos);
}

TEST(GraphViz, refusesAPathOfAnotherGraph) {
  PathResult path;
  path.edges = {17};
  std::ostringstream out;
  EXPECT_THROW(writeGraphViz(out, roadAndGrass(), path), std::out_of_range);
  EXPECT_TRUE(out.str().empty());
}

TEST(GraphViz, noticesAStreamThatFails) {
  std::ostringstream out;
  out.setstate(std::ios::badbit);
  EXPECT_THROW(writeGraphViz(out, roadAndGrass()), std::ios_base::failure);
}
