#include <semantic_driving/PathCheck.h>

#include <algorithm>
#include <cmath>

namespace semantic_driving {

using semantic_planning::Fit;
using semantic_planning::PathPoint;
using semantic_planning::SemanticPlanner;

bool PathJudgment::isClearlyBetterThan(const PathJudgment& other, double mostBackwards) const {
  const bool backsUp = longestBackwards > mostBackwards;
  const bool otherBacksUp = other.longestBackwards > mostBackwards;
  if (backsUp != otherBacksUp) return otherBacksUp;
  const double same = std::max(kSameLength, kSameShare * other.length);  // m
  for (std::size_t rank = lengthPerRank.size(); rank-- > 1;) {
    const double more = lengthPerRank[rank] - other.lengthPerRank[rank];
    if (std::abs(more) > same) return more < 0;
  }
  return price < other.price - std::max(kSameLength, kSameShare * other.price);
}

PathCheck::PathCheck(const SemanticPlanner& planner)
    : m_planner(planner),
      m_checker(planner.ground(), planner.options().vehicle, planner.order(),
                planner.options().reading) {}

PathJudgment PathCheck::judge(const DrivePath& path, double from) const {
  PathJudgment judgment;
  judgment.lengthPerRank.resize(m_planner.order().ranks());
  judgment.longestBackwards = path.longestBackwards(from);
  if (!path.empty())
    judgment.price = m_checker.motionCost().of(path.part(from, path.length()).points());
  const double step = m_planner.ground().voxelSize();
  for (double s = from; s < path.length(); s += step) {
    const PathPoint p = path.at(s);
    const auto pose = m_checker.place(poseOf(p), p.z);
    const bool fits = pose && m_checker.fit(*pose) == Fit::Free;
    const colored_graph::Rank rank =
        fits ? m_planner.order().rank(m_checker.classAt(*pose)) : colored_graph::kForbidden;
    if (rank == colored_graph::kForbidden) {
      judgment.freeFor = std::min(judgment.freeFor, s - from);
      continue;
    }
    const double piece = std::min(step, path.length() - s);
    judgment.lengthPerRank[rank] += piece;
    judgment.length += piece;
  }
  return judgment;
}

}  // namespace semantic_driving
