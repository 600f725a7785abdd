#include <colored_graph/GraphSearch.h>

#include <stdexcept>

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

const char* describe(SearchStatus status) {
  switch (status) {
    case SearchStatus::Found:
      return "path found";
    case SearchStatus::StartNotInGraph:
      return "the start is not in the graph";
    case SearchStatus::GoalNotInGraph:
      return "the goal is not in the graph";
    case SearchStatus::NotConnected:
      return "start and goal are not connected";
    case SearchStatus::OnlyForbidden:
      return "every path goes through a forbidden class";
    case SearchStatus::CostOverflow:
      return "the cost of every path is too large to be represented";
    case SearchStatus::Cancelled:
      return "the search was cancelled";
  }
  throw std::out_of_range("a search status without a sentence");
}

}  // namespace colored_graph
