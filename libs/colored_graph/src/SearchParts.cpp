#include "SearchParts.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace colored_graph {
namespace {

template <class Passable>
bool reaches(const ColoredGraph& graph, VertexId from, VertexId to, const Passable& passable) {
  std::vector<bool> seen(graph.vertexIdEnd(), false);
  std::vector<VertexId> open{from};
  seen[from] = true;
  while (!open.empty()) {
    const VertexId v = open.back();
    open.pop_back();
    if (v == to) return true;
    for (const Incidence& i : graph.incident(v)) {
      if (seen[i.neighbor] || !passable(i)) continue;
      seen[i.neighbor] = true;
      open.push_back(i.neighbor);
    }
  }
  return false;
}

}  // namespace

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

std::optional<SearchStatus> missingEnd(const ColoredGraph& graph, VertexId start, VertexId goal) {
  if (!graph.containsVertex(start)) return SearchStatus::StartNotInGraph;
  if (!graph.containsVertex(goal)) return SearchStatus::GoalNotInGraph;
  return std::nullopt;
}

PathResult assemblePath(const ColoredGraph& graph, VertexId start, std::vector<EdgeId> edges) {
  PathResult result;
  result.status = SearchStatus::Found;
  result.vertices = {start};
  result.lengthPerClass.assign(graph.classes(), 0);
  for (const EdgeId e : edges) {
    const Edge edge = graph.edge(e);
    result.vertices.push_back(edge.other(result.vertices.back()));
    for (const Stretch& s : edge.profile) result.lengthPerClass[s.classId] += s.length;
  }
  result.edges = std::move(edges);
  return result;
}

SearchStatus diagnose(const ColoredGraph& graph, VertexId start, VertexId goal,
                      const std::function<bool(const Incidence&)>& allowed) {
  if (reaches(graph, start, goal, allowed)) return SearchStatus::CostOverflow;
  const auto notBlocked = [&](const Incidence& i) {
    const Edge& edge = graph.edge(i.edge);
    return edge.state != EdgeState::Blocked && edge.leadsTo(i.neighbor);
  };
  return reaches(graph, start, goal, notBlocked) ? SearchStatus::OnlyForbidden
                                                 : SearchStatus::NotConnected;
}

void evaluateEdge(ColoredGraph& graph, EdgeId e,
                  const std::function<std::optional<EdgeProfile>(EdgeId)>& evaluate) {
  if (!evaluate)
    throw std::invalid_argument("SearchOptions: edge " + std::to_string(e) +
                                " is unevaluated, and there is no function to evaluate it");
  if (std::optional<EdgeProfile> profile = evaluate(e))
    graph.setProfile(e, std::move(*profile));
  else
    graph.setBlocked(e);
}

}  // namespace colored_graph
