#include <colored_graph/PathResult.h>

namespace colored_graph {

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
    case SearchStatus::TimeLimit:
      return "the search ran into its time limit";
  }
  return "unknown status";
}

}  // namespace colored_graph
