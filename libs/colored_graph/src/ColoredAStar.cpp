#include <colored_graph/ColoredAStar.h>

#include "ColoredSearch.h"

namespace colored_graph {
namespace {

struct Task {
  ColoredGraph& graph;
  VertexId start, goal;
  const CostModel& model;
  const SearchOptions& options;
};

template <class Layout>
std::optional<PathResult> searchIn(const Task& t, StopCheck& stop, SearchStatistics& statistics) {
  return ColoredSearch<Layout>(t.graph, t.start, t.goal, t.model, t.options, stop).run(statistics);
}

/** In few bits if they are enough, else in as many as can be needed. */
PathResult search(const Task& task) {
  StopCheck stop(task.options);
  SearchStatistics statistics;
  std::optional<PathResult> result;
  if (PackedLayout::suits(task.model)) result = searchIn<PackedLayout>(task, stop, statistics);
  if (!result)
    result = withVectorSize(task.model, [&](auto size) {
      return searchIn<VectorLayout<size()>>(task, stop, statistics);
    });
  result->statistics = statistics;
  return *result;
}

}  // namespace

PathResult findColoredPath(ColoredGraph& graph, VertexId start, VertexId goal,
                           const CostModel& model, const SearchOptions& options) {
  model.validate(graph);
  if (const auto missing = missingEnd(graph, start, goal)) {
    PathResult result;
    result.status = *missing;
    return result;
  }
  return search({graph, start, goal, model, options});
}

}  // namespace colored_graph
