#pragma once
#include <colored_graph/ColoredReplanner.h>

#include <optional>

namespace colored_graph {

/** A search for the best path in a graph: what a planner asks, and anybody may implement. */
class GraphSearch {
 public:
  virtual ~GraphSearch() = default;

  /** The best path in a graph that was not searched before. The search remembers nothing; the graph
   * keeps the profiles of the edges that were evaluated. */
  virtual PathResult search(ColoredGraph& graph, VertexId start, VertexId goal,
                            const CostModel& model, const SearchOptions& options) = 0;
  /** The best path in a graph that changes between calls (ColoredGraph's change log tells how),
   * from a start that moves. The search may keep what it found for the next call: forget() comes
   * before the graph goes. */
  virtual PathResult replan(ColoredGraph& graph, VertexId start, VertexId goal,
                            const CostModel& model, const SearchOptions& options) {
    return search(graph, start, goal, model, options);
  }
  virtual void forget() {}
};

/** COA* (findColoredPath()), and COLPA* (ColoredReplanner) from the second search on. */
class ColoredGraphSearch : public GraphSearch {
 public:
  PathResult search(ColoredGraph& graph, VertexId start, VertexId goal, const CostModel& model,
                    const SearchOptions& options) override;
  /** Another goal, or another graph: it begins anew. */
  PathResult replan(ColoredGraph& graph, VertexId start, VertexId goal, const CostModel& model,
                    const SearchOptions& options) override;
  void forget() override { m_replanner.reset(); }

 private:
  std::optional<ColoredReplanner> m_replanner;
  const ColoredGraph* m_graph = nullptr;
  VertexId m_goal = kNoVertex;
};

}  // namespace colored_graph
