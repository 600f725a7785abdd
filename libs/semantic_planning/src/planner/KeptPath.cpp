#include "KeptPath.h"

#include <algorithm>
#include <cmath>

#include "PathImprovement.h"

namespace semantic_planning {

void KeptPath::keep(const PlanResult& plan, double least) {
  m_plan = plan;
  m_excess = plan.price - least;
  m_changed = false;
}

void KeptPath::groundChanged(const std::vector<Column>& tiles) {
  if (tiles.empty()) return;
  m_changed = true;
  if (!lookAgain()) drop();
}

/** \return whether it is free. */
bool KeptPath::lookAgain() {
  for (PathPoint& p : m_plan.path) {
    const auto pose = m_checker.place({p.x, p.y, p.heading}, p.z);
    if (!pose || m_checker.fit(*pose) != Fit::Free) return false;
    const ClassId id = m_checker.classAt(*pose);
    if (m_checker.order().rank(id) == colored_graph::kForbidden) return false;
    p.classId = id;
    p.z = m_checker.ground().centerOf(pose->z);
  }
  return true;
}

std::optional<PlanResult> KeptPath::restFrom(const GroundPose& pose) const {
  constexpr double kNear = 0.02, kSameHeading = 0.02;  // m, radians
  const auto on = std::find_if(m_plan.path.begin(), m_plan.path.end(), [&](const PathPoint& p) {
    // Between two points it is half a voxel from one of them at most, and on the line to the next.
    const double dx = pose.pose.x - p.x, dy = pose.pose.y - p.y;
    const double sideways = dy * std::cos(p.heading) - dx * std::sin(p.heading);
    return std::hypot(dx, dy) <= m_checker.ground().voxelSize() / 2 && std::abs(sideways) < kNear &&
           std::abs(std::remainder(pose.pose.phi - p.heading, 2 * M_PI)) <
               kSameHeading +
                   m_checker.ground().voxelSize() / m_checker.reedsShepp().turningRadius();
  });
  if (on == m_plan.path.end()) return std::nullopt;
  PlanResult rest;
  rest.status = PlanStatus::Found;
  rest.path.assign(on, m_plan.path.end());
  PathPoint& first = rest.path.front();
  first.x = pose.pose.x, first.y = pose.pose.y, first.heading = pose.pose.phi;
  double begin = first.arcLength;
  if (const PathPoint* next = rest.path.size() > 1 ? &rest.path[1] : nullptr)
    begin = next->arcLength - std::hypot(next->x - first.x, next->y - first.y);
  first.arcLength = begin;
  for (PathPoint& p : rest.path) p.arcLength -= begin;
  setLengths(rest, m_checker, m_prices);
  return rest;
}

bool KeptPath::mayBeBeaten(const PlanResult& rest, double least) const {
  constexpr double kGain = 0.5;  // m
  return rest.price - least > m_excess + kGain;
}

}  // namespace semantic_planning
