#include <colored_graph/GraphSearch.h>

#include <colored_graph/ColoredAStar.h>

#include "LifelongSearch.h"

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

ColoredReplanner::ColoredReplanner(ColoredGraph& graph, VertexId start, VertexId goal,
                                   const CostModel& model, const SearchOptions& options) {
  model.validate(graph);
  m_impl = withVectorSize(model, [&](auto size) -> std::unique_ptr<Impl> {
    return std::make_unique<Search<size()>>(graph, start, goal, model, options);
  });
}

ColoredReplanner::~ColoredReplanner() = default;
ColoredReplanner::ColoredReplanner(ColoredReplanner&&) noexcept = default;
ColoredReplanner& ColoredReplanner::operator=(ColoredReplanner&&) noexcept = default;

PathResult ColoredReplanner::solve() { return m_impl->solve(); }

void ColoredReplanner::moveStart(VertexId start) { m_impl->moveStart(start); }

PathResult findColoredPath(ColoredGraph& graph, VertexId start, VertexId goal,
                           const CostModel& model, const SearchOptions& options) {
  return ColoredReplanner(graph, start, goal, model, options).solve();
}

}  // namespace colored_graph
