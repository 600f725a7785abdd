#include <semantic_driving/Explorer.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::PlanResult;
using semantic_planning::SemanticPlanner;

void Explorer::moveTo(const TPose2D& pose, double z) {
  const TPose2D before = std::exchange(m_pose, pose).value_or(pose);
  const auto ground = m_planner.ground().find(pose.x, pose.y, z);
  const auto rank =
      ground ? m_planner.order().rank(ground->surface.classId) : colored_graph::kForbidden;
  const int worse = rank == colored_graph::kForbidden ? 0 : rank;
  m_effort.spent += std::hypot(pose.x - before.x, pose.y - before.y) * (worse + 1);
}

Exploration Explorer::places(const TPose2D& from, double z, const TPose2D& goal) {
  constexpr double kAround = 8;  // m
  const auto isThere = [&](const TPose2D& pose) {
    return std::hypot(pose.x - goal.x, pose.y - goal.y) < kAround;
  };
  Exploration found = findFrontiers(m_planner, from, z, goal, m_seen, m_effort);
  std::vector<Frontier>& frontiers = found.frontiers;
  m_wasThere = m_wasThere || isThere(from);
  if (m_wasThere && found.goalReached)
    frontiers.erase(std::remove_if(frontiers.begin(), frontiers.end(),
                                   [&](const Frontier& f) { return !isThere(f.pose); }),
                    frontiers.end());
  m_exhausted = m_wasThere && found.goalReached && frontiers.empty();
  if (m_effort.expected == 0 && !found.frontiers.empty())
    m_effort.expected = m_effort.spent + found.hoped;
  return found;
}

std::optional<Explorer::Way> Explorer::choose(const Exploration& places, const TPose2D& from,
                                              double z,
                                              const std::function<DrivePath(DrivePath)>& joined,
                                              bool last) {
  constexpr double kShortestWay = 0.5;  // m; nearer frontiers are seen from here
  const semantic_planning::MotionCost price(m_planner.options().vehicle);
  Poses useless;  // if it is not seen from there, it is not seen
  std::optional<Frontier> chosen;
  std::optional<Way> way;
  for (Frontier f : places.frontiers) {
    if (chosen && f.cost >= chosen->cost) break;
    PlanResult plan = m_planner.plan(from, f.pose, z, f.z);
    if (!plan.found() || plan.length < kShortestWay) {
      useless.push_back(f.pose);
      continue;
    }
    DrivePath path = joined(DrivePath(plan.path));
    f.cost += price.of(path.points()) - path.length();
    if (chosen && f.cost >= chosen->cost) continue;
    chosen = f;
    way = Way{std::move(plan), std::move(path)};
  }
  if (chosen) useless.push_back(chosen->pose);
  // If there is no way to any, it may be for where the vehicle stands.
  if (way)
    m_tried = std::move(useless);
  else if (last)
    m_seen.insert(m_seen.end(), useless.begin(), useless.end());
  return way;
}

void Explorer::end(bool drives) {
  if (drives) m_seen.insert(m_seen.end(), m_tried.begin(), m_tried.end());
  m_tried.clear();
}

}  // namespace semantic_driving
