#include <colored_graph/GraphViz.h>

#include <algorithm>
#include <iomanip>
#include <ios>
#include <locale>
#include <sstream>

namespace colored_graph {
namespace {

std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << std::quoted(text);
  return out.str();
}

std::string fixed(double value, int digits) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

std::string colorOf(const GraphVizOptions& options, GraphClass id) {
  return quoted(options.color ? options.color(id) : "black");
}

GraphClass longestClass(const Stretches& profile) {
  const auto shorter = [](const Stretch& l, const Stretch& r) { return l.length < r.length; };
  return std::max_element(profile.begin(), profile.end(), shorter)->classId;
}

std::string vertexAttributes(const ColoredGraph& graph, VertexId v,
                             const GraphVizOptions& options) {
  std::string text = "color=" + colorOf(options, graph.vertexClass(v));
  if (!options.position) return text;
  const auto [x, y] = options.position(v);
  return text + " pos=\"" + fixed(x, 2) + "," + fixed(y, 2) + "\"";
}

std::string edgeAttributes(const Edge& edge, bool onPath, const GraphVizOptions& options) {
  std::string text = "label=\"" + fixed(toMeters(edge.length), 4) + "\"";
  switch (edge.state) {
    case EdgeState::Usable:
      text += " color=" + colorOf(options, longestClass(edge.profile));
      break;
    case EdgeState::Unevaluated:
      text += " style=dashed";
      break;
    case EdgeState::Blocked:
      text += " style=dotted";
      break;
  }
  if (!edge.leadsTo(edge.a)) text += " dir=forward";
  if (!edge.leadsTo(edge.b)) text += " dir=back";
  return onPath ? text + " penwidth=4" : text;
}

}  // namespace

void writeGraphViz(std::ostream& out, const ColoredGraph& graph, const PathResult& path,
                   const GraphVizOptions& options) {
  std::vector<bool> onPath(graph.edgeIdEnd(), false);
  for (const EdgeId e : path.edges) {
    graph.edge(e);  // throws for a path of another graph
    onPath[e] = true;
  }
  out << "graph colored {\n";
  for (VertexId v = 0; v < graph.vertexIdEnd(); ++v)
    if (graph.containsVertex(v))
      out << "  " << std::to_string(v) << " [" << vertexAttributes(graph, v, options) << "];\n";
  for (EdgeId e = 0; e < graph.edgeIdEnd(); ++e) {
    if (!graph.containsEdge(e)) continue;
    const Edge& edge = graph.edge(e);
    out << "  " << std::to_string(edge.a) << " -- " << std::to_string(edge.b) << " ["
        << edgeAttributes(edge, onPath[e], options) << "];\n";
  }
  out << "}\n" << std::flush;
  if (!out) throw std::ios_base::failure("GraphViz: the stream did not take the whole graph");
}

}  // namespace colored_graph
