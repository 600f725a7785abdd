#include <colored_graph/ColoredAStar.h>
#include <colored_graph/GraphSearch.h>

namespace colored_graph {

PathResult ColoredGraphSearch::search(ColoredGraph& graph, VertexId start, VertexId goal,
                                      const CostModel& model, const SearchOptions& options) {
  return findColoredPath(graph, start, goal, model, options);
}

PathResult ColoredGraphSearch::replan(ColoredGraph& graph, VertexId start, VertexId goal,
                                      const CostModel& model, const SearchOptions& options) {
  if (!m_replanner || m_graph != &graph || m_goal != goal)
    m_replanner.emplace(graph, start, goal, model, options);
  m_graph = &graph;
  m_goal = goal;
  m_replanner->moveStart(start);
  return m_replanner->solve();
}

}  // namespace colored_graph
