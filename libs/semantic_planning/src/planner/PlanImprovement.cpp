#include <algorithm>
#include <cmath>

#include "PathImprovement.h"
#include "PathTracing.h"
#include "PlannerCore.h"

namespace semantic_planning {

bool PlannerCore::mayImprove(const PlanResult& result) const {
  if (!m_options.shorten || m_model.edges != colored_graph::EdgeModel::Profile ||
      m_model.kind != colored_graph::CostKind::ArcLength)
    return false;
  return result.found() ? result.path.size() > 2
                        : result.status == PlanStatus::NotConnected ||
                              result.status == PlanStatus::OnlyForbidden;
}

/** Farther off than vertices lie, for it costs less than they do; if there is no way, wherever
 * there is ground. */
RelaxedPath PlannerCore::searchWideRelaxed() const {
  const std::size_t all = m_roadmap->reachable(*m_goalPose) ? m_ground.tiles().size() : 0;
  constexpr double kLeast = 1;  // m
  for (double buffer = m_options.roadmap.buffer;;) {
    buffer = std::max(kLeast, 2 * buffer);
    const PlanningRegion wide = region(buffer);
    RelaxedPath guide = searchRelaxed(m_checker, wide, *m_startPose, *m_goalPose);
    if (!guide.path.empty() || tilesIn(wide, m_ground).size() >= all) return guide;
  }
}

void PlannerCore::improve(StageClock& clock, PlanResult& result) {
  const RelaxedPath guide = searchWideRelaxed();
  clock.end("guide");
  const ImprovementOptions options{RoadmapOptions::kLongestEdge, m_options.classTolerance};
  PathOrder::Lengths least;
  improvePath(result, least, guide.path, m_checker, options);
  clock.end("shorten");
  const PathOrder order(m_checker, m_options.classTolerance);
  constexpr int kWithoutPath = 3;
  const auto most = [&] {
    return result.found() ? m_options.refinements : std::max(kWithoutPath, m_options.refinements);
  };
  for (int i = 0; i < most() && mayBeBetter(result, guide); ++i) {
    PlanResult offered = refined(guide, i, result);
    improvePath(offered, least, {}, m_checker, options);
    if (order.isBetter(offered, result, least)) result = std::move(offered);
    clock.end("refine");
  }
}

bool PlannerCore::mayBeBetter(const PlanResult& result, const RelaxedPath& guide) const {
  constexpr double kMoreLength = 1.1, kMoreOfAClass = 0.3;  // m
  const bool isRefinable =
      m_options.roadmap.kind == GraphKind::Compressed || m_options.roadmap.kind == GraphKind::Full;
  if (guide.path.empty() || !isRefinable) return false;
  if (!result.found() || result.length > kMoreLength * guide.path.back().arcLength) return true;
  const auto ranks = PathOrder(m_checker, 0).ranks(result);
  for (std::size_t i = 0; i < ranks.size(); ++i) {  // the worst first
    const double more = colored_graph::toMeters(ranks[i]) - guide.lengthPerRank[ranks.size() - i];
    if (std::abs(more) > kMoreOfAClass) return more > 0;
  }
  return false;
}

PlanResult PlannerCore::refined(const RelaxedPath& guide, int round, const PlanResult& before) {
  constexpr std::size_t kEvery = 4;        // point of the guide
  constexpr double kDistance = 3;          // m
  constexpr std::size_t kVertices = 1000;  // whatever the first graph has: more are never worse
  std::vector<mrpt::math::TPoint2D> path;
  for (std::size_t i = 0; i < guide.path.size(); i += kEvery)
    path.emplace_back(guide.path[i].x, guide.path[i].y);
  RoadmapOptions options = m_options.roadmap;
  options.headings *= 2;
  options.vertices = kVertices << round;
  MapRoadmap fine(m_candidates, m_checker, options, *m_startPose,
                  guide.region.near(path, kDistance));
  const VertexId start = fine.roadmap().addQueryVertex(*m_startPose);
  const VertexId goal = fine.roadmap().addQueryVertex(*m_goalPose);
  PlanResult result = before;
  describePath(search(fine.roadmap(), start, goal), fine.roadmap(), m_checker, result);
  m_edges.takeRemembered();  // what is told is that of the first graph
  result.search = before.search;
  result.roadmapCost = before.roadmapCost;
  return result;
}

}  // namespace semantic_planning
