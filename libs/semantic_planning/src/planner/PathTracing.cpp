#include "PathTracing.h"

#include <algorithm>
#include <array>

namespace semantic_planning {

using colored_graph::PathResult;
using colored_graph::SearchStatus;

namespace {

PlanStatus statusOf(SearchStatus status) {
  switch (status) {
    case SearchStatus::Found:
      return PlanStatus::Found;
    case SearchStatus::OnlyForbidden:
      return PlanStatus::OnlyForbidden;
    case SearchStatus::Cancelled:
      return PlanStatus::Cancelled;
    default:
      return PlanStatus::NotConnected;
  }
}

}  // namespace

void appendCurve(const std::vector<PathPoint>& curve, std::vector<PathPoint>& path) {
  const double begin = path.empty() ? 0 : path.back().arcLength;
  for (std::size_t i = path.empty() ? 0 : 1; i < curve.size(); ++i) {
    path.push_back(curve[i]);
    path.back().arcLength += begin;
  }
}

bool mayFit(const ReedsSheppCurve& curve, double z, const CollisionChecker& checker) {
  // Near its end first: goals are where there is little room.
  constexpr std::array<double, 4> kShares = {0.9, 0.5, 0.25, 0.75};
  return std::all_of(kShares.begin(), kShares.end(), [&](double share) {
    const auto placed = checker.place(curve.at(share * curve.length()).pose, z);
    return placed && checker.fit(*placed) == Fit::Free;
  });
}

std::vector<PathPoint> tracePath(const PathResult& path, const Roadmap& roadmap,
                                 const CollisionChecker& checker) {
  std::vector<PathPoint> points;
  for (std::size_t i = 0; i < path.edges.size(); ++i) {
    const auto from = path.vertices[i];
    appendCurve(checker.trace(roadmap.curve(path.edges[i], from), roadmap.pose(from).z), points);
  }
  return points;
}

void setLengths(const PathResult& path, PlanResult& result) {
  result.cost = path.cost;
  result.lengthPerClass.clear();
  result.length = 0;
  for (const colored_graph::Length length : path.lengthPerClass) {
    result.lengthPerClass.push_back(colored_graph::toMeters(length));
    result.length += result.lengthPerClass.back();
  }
}

void describePath(const PathResult& path, const Roadmap& roadmap, const CollisionChecker& checker,
                  PlanResult& result) {
  result.status = statusOf(path.status);
  result.search = path.statistics;
  if (!path.found()) {
    result.reason = describe(path.status);
    return;
  }
  setLengths(path, result);
  for (const auto v : path.vertices) result.vertices.push_back(roadmap.pose(v).pose);
  result.path = tracePath(path, roadmap, checker);
}

}  // namespace semantic_planning
